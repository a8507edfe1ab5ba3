#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/io/pose_graph_stream.hpp"
#include "isotherm/slam/online/online_consensus.hpp"
#include "option_verb.hpp"
#include "unsigned_flag.hpp"
#include "verbs/follow/call_times.hpp"
#include "verbs/follow/error_track.hpp"
#include "verbs/follow/event_lines.hpp"
#include "verbs/follow/state_file.hpp"
#include "verbs/input/truth_input.hpp"
#include "verbs/prune/prune_result.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;
using spectral::Verdict;

struct FollowVerb : OptionVerb<OnlineOptions> {
  std::string input;
  std::string output;
  std::string verdicts;
  std::string events = "-";
  std::string state;
  std::string map;
  std::string times;
  GroundTruthSource truth;
  std::uint64_t every = 0;
  bool keep_ambiguous = false;

  int run() {
    if (resolve_or_dump()) return kOk;
    check_flags();
    // What else goes to stdout has it for itself.
    if (output == "-" || verdicts == "-" || flags.json == "-") {
      if (events == "-") events.clear();
    }
    std::ifstream file;
    if (input != "-") {
      file.open(input);
      if (!file) throw FileError(input, "cannot be opened");
    }
    PoseGraphStream stream(input == "-" ? std::cin : file, input);
    std::vector<VertexId> fixed;  // before it is known whether poses are planar
    while (auto entry = stream.next()) {
      if (const auto* held = std::get_if<StreamFixed>(&*entry)) {
        fixed.push_back(held->id);
        continue;
      }
      const bool planar = std::holds_alternative<StreamVertex<Pose2>>(*entry) ||
                          std::holds_alternative<StreamEdge<Pose2>>(*entry);
      return planar ? follow<Pose2>(stream, *entry, fixed) : follow<Pose3>(stream, *entry, fixed);
    }
    throw ParseError(
        {input, stream.line_number(), 0}, "",
        "no vertex and no edge; expected a pose graph in g2o, TORO, IRL or JRL format");
  }

  void check_flags() const {
    if ((map.empty() && truth.path.empty()) != (every == 0)) {
      throw InvalidArgument("--every", "goes with --map or --ground-truth");
    }
    if (!truth.path.empty() && input == "-") {
      throw InvalidArgument("--ground-truth",
                            "needs a file to follow, not stdin: true poses are "
                            "matched with those of the whole graph");
    }
  }

  template <class Pose>
  class Session;

  template <class Pose>
  int follow(PoseGraphStream& stream, StreamEntry first, const std::vector<VertexId>& fixed);
};

// Follows one stream to its end.
template <class Pose>
class FollowVerb::Session {
 public:
  Session(FollowVerb& verb, PoseGraphStream& stream)
      : verb_(verb),
        stream_(stream),
        events_(verb.events),
        state_(verb.state),
        online_(state_.open<Pose>(verb.options, context(verb))) {
    // A file is followed again from its start; what is known of it is passed over.
    known_ = verb.input == "-" ? 0 : state_.entries();
    const auto known = online_.input();
    edges_ = known.constraints.size();
    seen_.insert(known.ids.begin(), known.ids.end());
    if (verb.truth.path.empty()) return;
    const auto whole = read_pose_graph(verb.input);
    errors_.emplace(as<Pose>(whole.graph), verb.truth, verb.flags);
  }

  void take(const StreamEntry& entry) {
    if (known_ > 0) {
      --known_;
      return;
    }
    if (const auto* held = std::get_if<StreamFixed>(&entry)) {
      online_.fix(held->id);
    } else if (const auto* vertex = std::get_if<StreamVertex<Pose>>(&entry)) {
      online_.set_pose(vertex->id, vertex->pose);
    } else if (const auto* edge = std::get_if<StreamEdge<Pose>>(&entry)) {
      add(*edge);
    } else {
      throw ParseError({verb_.input, stream_.line_number(), 0}, "",
                       Pose::kDim == 2 ? "spatial record among planar poses"
                                       : "planar record among spatial poses");
    }
  }

  void finish() {
    CallTimes took;
    for (const auto& change : took.of(seen_.size(), [this] { return online_.finish(); })) {
      events_.tell(change, now());
    }
    const auto decided = online_.verdicts();
    const bool with_map = errors_ || !verb_.output.empty();
    const auto graph = with_map ? online_.graph() : online_.input();  // a map takes a solution
    if (errors_) tell_error(graph);
    events_.end(decided, now());
    if (!verb_.output.empty()) {
      write_g2o(verb_.output, apply_verdicts(graph, decided, verb_.keep_ambiguous));
    }
    if (!verb_.verdicts.empty()) write_loop_verdicts(verb_.verdicts, decided, graph.ids);
    times_.write(verb_.times);
    summarise(decided, took.total());
  }

 private:
  static RunContext context(const FollowVerb& verb) {
    return {verb.flags.threads, progress_line(verb.flags), verb.flags.seed};
  }

  void add(const StreamEdge<Pose>& edge) {
    const auto changes = times_.of(seen_.size(), [&] {
      return online_.add_edge(edge.from, edge.to, edge.measured.T_from_to,
                              edge.measured.information, edge.measured.link);
    });
    seen_.insert({edge.from, edge.to});
    state_.append(online_);  // before anything is said of it
    for (const auto& change : changes) events_.tell(change, now());
    ++edges_;
    if (verb_.every > 0 && edges_ % verb_.every == 0) tell_map();
  }

  EventLines::Time now() const { return {edges_, seen_.size()}; }

  void tell_map() {
    const auto graph = online_.graph();
    if (errors_) tell_error(graph);
    if (verb_.map.empty()) return;
    write_g2o(verb_.map, apply_verdicts(graph, online_.verdicts(), verb_.keep_ambiguous));
  }

  void tell_error(const PoseGraph<Pose>& graph) {
    if (const auto ate = errors_->ate(graph, seen_)) events_.error(*ate, now());
  }

  void summarise(const spectral::EdgeVerdicts& decided, double finish) const {
    say(verb_.flags,
        fmt::format("{}, {}: {} kept, {} pruned, {} ambiguous; a call {:.2f} ms (median), {:.1f} "
                    "ms (99 %), {:.0f} ms (worst); {:.2f} s in all, and {:.2f} s to finish",
                    counted(edges_, "edge"), counted(decided.size(), "loop"),
                    count(decided, Verdict::keep), count(decided, Verdict::prune),
                    count(decided, Verdict::ambiguous), times_.wall_quantile(0.5),
                    times_.wall_quantile(0.99), times_.wall_quantile(1.0), times_.total(), finish));
    Json json = {{"schema", "isotherm.follow/1"},
                 {"edges", edges_},
                 {"loops", decided.size()},
                 {"kept", count(decided, Verdict::keep)},
                 {"pruned", count(decided, Verdict::prune)},
                 {"ambiguous", count(decided, Verdict::ambiguous)},
                 {"seconds", times_.total()},
                 {"finish_seconds", finish},
                 {"options", options_to_json(verb_.options)}};
    json.update(times_.summary());
    if (errors_) {
      const auto mean = errors_->mean();
      json["iate_m"] = mean ? Json(*mean) : Json();
    }
    write_json(verb_.flags.json, json);
  }

  FollowVerb& verb_;
  PoseGraphStream& stream_;
  EventLines events_;
  StateFile state_;
  OnlineConsensus<Pose> online_;
  std::uint64_t known_ = 0;
  std::uint64_t edges_ = 0;
  std::set<VertexId> seen_;  // poses that edges have named
  CallTimes times_;
  std::optional<ErrorTrack<Pose>> errors_;
};

template <class Pose>
int FollowVerb::follow(PoseGraphStream& stream, StreamEntry first,
                       const std::vector<VertexId>& fixed) {
  Session<Pose> session(*this, stream);
  for (const VertexId id : fixed) session.take(StreamFixed{id});
  session.take(first);
  while (const auto entry = stream.next()) session.take(*entry);
  session.finish();
  return kOk;
}

}  // namespace

Verb add_follow(CLI::App& root) {
  auto follow = std::make_shared<FollowVerb>();
  CLI::App* verb = root.add_subcommand("follow", "judge loop closures while a pose graph comes in");
  verb->add_option("input", follow->input,
                   "pose graph whose lines stand in order of time (- for stdin)")
      ->required();
  auto& outputs = follow->flags.outputs;
  outputs.add(*verb, "-o,--output", follow->output,
              "pruned pose graph to write at the end, with estimated poses (- for stdout)",
              {".g2o"});
  outputs.add(*verb, "--verdicts", follow->verdicts, "final decision a loop, as CSV", {".csv"});
  outputs.add(*verb, "--events", follow->events,
              "a JSON line for every verdict that is new or changed (- for stdout, the default)",
              {});
  outputs.add(*verb, "--state", follow->state,
              "file that keeps what has come; a run that was ended goes on from it", {});
  outputs.add(*verb, "--map", follow->map, "g2o file to write the present map to, time and again",
              {".g2o"});
  add_unsigned(*verb, "--every", follow->every,
               "edges after which it is written again, and held against the truth");
  outputs.add(*verb, "--times", follow->times, "how long each call took, as CSV", {".csv"});
  verb->add_option("--ground-truth", follow->truth.path,
                   "pose graph or trajectory taken as true: the error of the map is an event, too")
      ->type_name("FILE");
  verb->add_option("--timestamps", follow->truth.timestamps,
                   "seconds of every vertex, one a line; the truth is interpolated at them")
      ->type_name("FILE");
  add_truth_flags(*verb, follow->truth);
  verb->add_flag("--keep-ambiguous", follow->keep_ambiguous,
                 "leave loops that are not proven either way in the graph");
  follow->add_flags(*verb);
  return verb_of(verb, follow);
}

}  // namespace isotherm::apps
