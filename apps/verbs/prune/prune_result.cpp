#include "verbs/prune/prune_result.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;
using spectral::Verdict;

// JSON has no infinity; null stands for "no threshold".
Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json to_json(const HeatRound& round) {
  return {{"scale", round.scale},           {"threshold", finite_or_null(round.threshold)},
          {"separation", round.separation}, {"konst", round.konst},
          {"candidates", round.candidates}, {"pruned", round.pruned}};
}

// Why each candidate was decided as it was; edges are numbered as in the verdicts.
Json to_json(const ConsensusDetail& detail, std::size_t candidate,
             const spectral::EdgeVerdicts& verdicts) {
  Json conflicts = Json::array();
  for (const Index other : detail.conflicts) conflicts.push_back(verdicts[other].edge);
  return {{"edge", verdicts[candidate].edge},
          {"probability", finite_or_null(verdicts[candidate].probability)},
          {"evidence", finite_or_null(detail.evidence)},
          {"chi2", finite_or_null(detail.chi2)},
          {"connected", detail.connected},
          {"conflicts", std::move(conflicts)}};
}

Json to_json(const ConsensusResult& result, const spectral::EdgeVerdicts& verdicts) {
  Json json = {{"log_evidence", finite_or_null(result.log_evidence)},
               {"odometry_scale", result.odometry_scale},
               {"loop_scale", result.loop_scale},
               {"odometry_scales", result.odometry_scales},
               {"loop_scales", result.loop_scales},
               {"odometry_slips", Json::array()},
               {"odometry_bias", result.odometry_bias},
               {"rotation_scale", result.rotation_scale},
               {"share_of_worse", result.share_of_worse},
               {"settled", result.settled},
               {"moves", Json::array()},
               {"loops", Json::array()}};
  for (const auto& slip : result.odometry_slips) {
    json["odometry_slips"].push_back(
        {{"from", slip.from}, {"to", slip.to}, {"factor", slip.factor}});
  }
  for (const auto& move : result.moves) {
    json["moves"].push_back(
        {{"accepted", move.accepted}, {"dropped", move.dropped}, {"in_force", move.in_force}});
  }
  for (std::size_t k = 0; k < result.details.size(); ++k) {
    json["loops"].push_back(to_json(result.details[k], k, verdicts));
  }
  return json;
}

}  // namespace

Json to_json(const PruneResult& result, const PruneOptions& options) {
  Json json = {{"schema", "isotherm.prune/1"},
               {"method", result.method},
               {"candidates", result.verdicts.size()},
               {"kept", count(result.verdicts, Verdict::keep)},
               {"pruned", count(result.verdicts, Verdict::prune)},
               {"ambiguous", count(result.verdicts, Verdict::ambiguous)},
               {"seconds", result.seconds},
               {"warnings", result.warnings},
               {"options", options_to_json(options)}};
  if (!result.rounds.empty()) {
    json["rounds"] = Json::array();
    for (const auto& round : result.rounds) json["rounds"].push_back(to_json(round));
  }
  if (result.method == ConsensusOptions::method()) {
    json["consensus"] = to_json(result.consensus, result.verdicts);
  }
  return json;
}

void tell(const PruneResult& result, const CommonFlags& flags) {
  for (const auto& warning : result.warnings) warn(flags, warning);
  for (const auto& move : result.consensus.moves) {
    detail_line(flags, fmt::format("{} loops accepted, {} dropped, {} in force", move.accepted,
                                   move.dropped, move.in_force));
  }
  for (const auto& round : result.rounds) {
    detail_line(flags, fmt::format("scale {:>6}: {} of {} loops pruned, threshold {:.4g}",
                                   round.scale, round.pruned, round.candidates, round.threshold));
  }
  say(flags,
      fmt::format("{}: {}, {} kept, {} pruned, {} ambiguous, {:.2f} s", result.method,
                  counted(result.verdicts.size(), "loop"), count(result.verdicts, Verdict::keep),
                  count(result.verdicts, Verdict::prune),
                  count(result.verdicts, Verdict::ambiguous), result.seconds));
}

void write_loop_verdicts(const std::string& path, const spectral::EdgeVerdicts& verdicts,
                         const std::vector<VertexId>& ids) {
  const bool lettered =
      std::any_of(ids.begin(), ids.end(), [](VertexId id) { return !robot_letter(id).empty(); });
  spectral::write_verdicts(path, verdicts, lettered ? vertex_name : spectral::VertexNames());
}

}  // namespace isotherm::apps
