#include "isotherm/network/localize/localize.hpp"
#include "isotherm/base/words.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/network/io/position_file.hpp"
#include "isotherm/network/io/range_file.hpp"
#include "isotherm/network/localize/anchor_conflicts.hpp"
#include "isotherm/slam/ranges/locate.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"
#include "option_verb.hpp"
#include "report/build/network_report.hpp"
#include "report/report_flags.hpp"
#include "verbs/localize/locate_robots.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace network;
using spectral::Verdict;

// A name that is a number as numbers are written: 007 is a name.
std::optional<std::uint64_t> number_in(const std::string& name) {
  std::uint64_t number = 0;
  const auto end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data(), end, number);
  if (error != std::errc() || stop != end || std::to_string(number) != name) return std::nullopt;
  return number;
}

// How many nodes ended which way.
std::string node_counts(const RangeNetwork& network, const LocalizeResult& result) {
  std::string line = counted(network.node_count(), "node");
  for (const auto& [status, name] : enum_names(NodeStatus{})) {
    const auto nodes = result.count(status);
    const bool many_anchors = status == NodeStatus::anchor && nodes > 1;
    if (nodes > 0) line += fmt::format(", {} {}{}", nodes, name, many_anchors ? "s" : "");
  }
  return line;
}

// What a network in which no node found a place lacks, by what most of its nodes are.
std::string what_would_help(const RangeNetwork& network, const LocalizeResult& result) {
  const int d = network.dimension;
  std::array<std::pair<std::int64_t, std::string>, 4> remedies = {
      {{result.count(NodeStatus::not_rigid),
        fmt::format("ranges from each node to {} others at least", d + 1)},
       {result.count(NodeStatus::mirrored),
        fmt::format("anchors, or neighbours, that do not all lie {}",
                    d == 2 ? "on a line" : "in a plane")},
       {result.count(NodeStatus::not_connected),
        result.anchored ? "ranges that lead to the anchors" : "ranges that connect the nodes"},
       {result.count(NodeStatus::not_placed),
        "more ranges that agree with each other, or true standard deviations"}}};
  std::ranges::stable_sort(remedies, std::greater{}, [](const auto& r) { return r.first; });
  return remedies.front().second;
}

// Of networks, and of robots that move among beacons.
struct LocalizeChoices {
  LocalizeOptions network;
  slam::LocateOptions robots;

  void validate() const {
    network.validate();
    robots.validate();
  }
};

template <class Choices, class Visitor>
requires std::same_as<std::remove_const_t<Choices>, LocalizeChoices>
void visit_fields(Choices& choices, Visitor&& visit) {
  visit_fields(choices.network, visit);
  visit_fields(choices.robots, visit);
}

// All that is left of an input.
std::string rest_of(TextReader& reader) {
  std::string text;
  while (reader.next_line()) {
    text += reader.line();
    text += '\n';
  }
  return text;
}

struct LocalizeVerb : OptionVerb<LocalizeChoices> {
  std::string input;
  std::string odometry;
  std::string anchors;
  std::string output;
  std::string trajectory;
  std::string verdicts;
  std::string truth;
  bool file_anchors = false;
  ReportFlags explain;
  int dimension = 0;

  int run() {
    if (resolve_or_dump()) return kOk;
    options.network.threads = flags.threads;
    options.network.progress = progress_line(flags);
    if (!truth.empty()) explain.require_wanted("--ground-truth");
    TextReader reader(input);
    const auto text = rest_of(reader);
    auto robots = read_robots(reader.path(), text, odometry, flags);
    if (robots) return run_robots(std::move(*robots));
    if (!trajectory.empty()) throw InvalidArgument("trajectory", "needs an input with odometry");
    const auto network = read_network(reader.path(), text);
    const auto result = localize(network, options.network);
    return conclude(network, result, to_json(network, result));
  }

  int run_robots(slam::AnyRangeGraph graph) {
    const auto outcome =
        locate_robots({std::move(graph), anchors, file_anchors}, options.robots, trajectory, flags);
    auto json = to_json(outcome.network, outcome.result);
    json["method"] = "ranges-and-odometry";
    for (const auto& [key, value] : outcome.summary.items()) json[key] = value;
    return conclude(outcome.network, outcome.result, json);
  }

  int conclude(const RangeNetwork& network, const LocalizeResult& result, const Json& json) {
    report(network, result, json["method"].get<std::string>());
    if (!output.empty()) write_positions(output, network, result);
    if (explain.wanted()) {
      const LocalizeRun run{file_title(input), options.network, true_positions(network)};
      write_report(explain, network_report(network, result, run));
    }
    if (!verdicts.empty()) write_verdicts_of(network, result);
    write_json(flags.json, json);
    if (nothing_found(network, result)) return fail(network, result);
    return result.status == LocalizeStatus::not_converged ? kNotConverged : kOk;
  }

  void write_verdicts_of(const RangeNetwork& network, const LocalizeResult& result) const {
    auto all = result.verdicts;
    const bool numbered = number_ends(all, network);
    const spectral::VertexNames names = [&](std::uint64_t node) { return network.names[node]; };
    spectral::write_verdicts(verdicts, all, numbered ? spectral::VertexNames() : names);
  }

  static bool nothing_found(const RangeNetwork& network, const LocalizeResult& result) {
    return result.count(NodeStatus::localised) == 0 &&
           result.count(NodeStatus::anchor) < network.node_count();
  }

  // Nobody is served by a success without a single position.
  static int fail(const RangeNetwork& network, const LocalizeResult& result) {
    complain(fmt::format("no node could be localised ({}); what would help: {}",
                         node_counts(network, result), what_would_help(network, result)));
    return kNotConverged;
  }

  RangeNetwork read_network(const std::string& path, const std::string& text) const {
    TextReader reader(path, text);
    auto file = read_ranges(reader, {.strict = flags.strict});
    for (const auto& diagnostic : file.report.diagnostics) warn(flags, to_string(diagnostic));
    auto& network = file.network;
    if (!anchors.empty()) {
      for (const auto& name : set_anchors(network, read_positions(anchors))) {
        if (flags.strict) throw InvalidArgument("anchors", "no range leads to " + name);
        warn(flags, "no range leads to the anchor " + name);
      }
    } else if (!file_anchors) {
      network.landmarks.clear();
    }
    if (dimension != 0 && dimension != network.dimension) {
      if (!network.landmarks.empty()) {
        throw InvalidArgument("dimension", "is that of the anchors where there are any");
      }
      network.dimension = dimension;
      network.positions.resize(0, 0);
    }
    return std::move(network);
  }

  // In the order of the network's nodes; NaN for those the file does not have.
  Eigen::MatrixXd true_positions(const RangeNetwork& network) const {
    if (truth.empty()) return {};
    const auto known = read_positions(truth);
    if (known.dimension() != network.dimension) {
      throw InvalidArgument("ground-truth", "has another number of coordinates than the network");
    }
    const auto column_of = known.column_of();
    Eigen::MatrixXd positions = Eigen::MatrixXd::Constant(network.dimension, network.node_count(),
                                                          std::numeric_limits<double>::quiet_NaN());
    for (Index v = 0; v < network.node_count(); ++v) {
      const auto found = column_of.find(network.names[v]);
      if (found != column_of.end()) positions.col(v) = known.positions.col(found->second);
    }
    return positions;
  }

  // Verdict files have numbers for vertices: the names, if all of them are numbers, which
  // this gives back, else the places of the nodes in order of first appearance.
  static bool number_ends(spectral::EdgeVerdicts& all, const RangeNetwork& network) {
    std::vector<std::uint64_t> ids;
    for (const auto& name : network.names) {
      const auto number = number_in(name);
      if (!number) return false;
      ids.push_back(*number);
    }
    for (auto& verdict : all) {
      verdict.from = ids[verdict.from];
      verdict.to = ids[verdict.to];
    }
    return true;
  }

  void report(const RangeNetwork& network, const LocalizeResult& result,
              std::string_view method) const {
    const auto& all = result.verdicts;
    say(flags,
        fmt::format("{}: {}, {} kept, {} pruned, {} ambiguous, {:.2f} s", method,
                    counted(all.size(), "range"), count(all, Verdict::keep),
                    count(all, Verdict::prune), count(all, Verdict::ambiguous), result.seconds));
    say(flags, node_counts(network, result));
    if (!result.anchored) say(flags, "no anchors: positions are known up to an isometry");
    for (Index v = 0; v < network.node_count(); ++v) {
      const auto status = result.nodes[v];
      if (status == NodeStatus::anchor || status == NodeStatus::localised) continue;
      detail_line(flags, fmt::format("node {}: {}", network.names[v], enum_name(status)));
    }
    for (const auto& conflict : anchor_conflicts(network, result)) {
      warn(flags, fmt::format("anchor {}: {} of its {} contradict where it is said to be",
                              network.names[conflict.anchor], conflict.against,
                              counted(conflict.ranges, "range")));
    }
    if (result.status == LocalizeStatus::not_converged) {
      warn(flags, "the refinement did not converge; see --max-iterations");
    }
  }

  Json to_json(const RangeNetwork& network, const LocalizeResult& result) const {
    Json nodes = Json::object();
    for (const auto& [status, name] : enum_names(NodeStatus{})) {
      nodes[std::string(name)] = result.count(status);
    }
    return {{"schema", "isotherm.localize/1"},
            {"method", enum_name(options.network.method)},
            {"dimension", network.dimension},
            {"anchored", result.anchored},
            {"nodes", nodes},
            {"candidates", result.verdicts.size()},
            {"kept", count(result.verdicts, Verdict::keep)},
            {"pruned", count(result.verdicts, Verdict::prune)},
            {"ambiguous", count(result.verdicts, Verdict::ambiguous)},
            {"status", enum_name(result.status)},
            {"noise_factor", result.noise_factor},
            {"sigma", result.sigma},
            {"chi2", result.chi2},
            {"dof", result.dof},
            {"iterations", result.iterations},
            {"rounds", result.rounds},
            {"seconds", result.seconds},
            {"options", options_to_json(options)}};
  }
};

}  // namespace

Verb add_localize(CLI::App& root) {
  auto localize = std::make_shared<LocalizeVerb>();
  CLI::App* verb = root.add_subcommand("localize", "find the nodes of a sensor network by ranges");
  verb->add_option("input", localize->input,
                   "ranges, with odometry or not: CSV, PyFG, libRSF, intervals (- for stdin)")
      ->required();
  CLI::Option* file =
      verb->add_option("--anchors", localize->anchors, "known positions, as CSV with node,x,y[,z]")
          ->type_name("FILE");
  verb->add_flag("--file-anchors", localize->file_anchors,
                 "landmarks whose position the input has are anchors")
      ->excludes(file);
  verb->add_option(
          "--odometry", localize->odometry,
          "PyFG or libRSF with the odometry of the robot whose ranges the input is a log of")
      ->type_name("FILE");
  verb->add_option("--dimension", localize->dimension,
                   "2 or 3; 0: that of the anchors, or of the input's kind")
      ->check(CLI::IsMember({0, 2, 3}))
      ->capture_default_str();
  auto& outputs = localize->flags.outputs;
  outputs.add(*verb, "-o,--output", localize->output,
              "positions, status and covariance of all nodes to write, as CSV", {".csv"});
  outputs.add(*verb, "--trajectory", localize->trajectory,
              "trajectory to write, of an input with odometry; of several robots one file each",
              {".tum", ".kitti", ".csv"});
  outputs.add(*verb, "--verdicts", localize->verdicts, "decision and reason a range, as CSV",
              {".csv"});
  localize->explain.add_to(*verb, outputs);
  verb->add_option("--ground-truth", localize->truth,
                   "true positions, as CSV with node,x,y[,z], for the report")
      ->type_name("FILE");
  localize->add_flags(*verb);
  return verb_of(verb, localize);
}

}  // namespace isotherm::apps
