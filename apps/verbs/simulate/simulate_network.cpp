#include "isotherm/network/simulate/simulate_network.hpp"
#include "isotherm/base/words.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/network/io/position_file.hpp"
#include "isotherm/network/io/range_file.hpp"
#include "isotherm/slam/evaluate/labels.hpp"
#include "option_verb.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace network;

// False and biased ranges are incorrect unless the noise alone could explain them.
std::vector<slam::EdgeLabel> labels_of(const SimulatedNetwork& simulated) {
  const double gate = chi_squared_quantile(0.999, 1);
  std::vector<slam::EdgeLabel> labels;
  for (std::size_t k = 0; k < simulated.origins.size(); ++k) {
    const auto& range = simulated.network.ranges[k];
    const double error =
        range.distance - (simulated.truth.col(range.from) - simulated.truth.col(range.to)).norm();
    slam::EdgeLabel label;
    label.edge = static_cast<std::int64_t>(k);
    label.from = static_cast<std::uint64_t>(range.from);
    label.to = static_cast<std::uint64_t>(range.to);
    if (simulated.origins[k] == RangeOrigin::measured) {
      label.label = slam::Label::correct;
    } else if (error * error > gate * range.variance) {
      label.label = slam::Label::incorrect;
    }
    labels.push_back(label);
  }
  return labels;
}

NamedPositions anchors_of(const SimulatedNetwork& simulated) {
  NamedPositions anchors;
  for (const Index v : simulated.network.landmarks) {
    anchors.names.push_back(simulated.network.names[v]);
  }
  anchors.positions = simulated.truth(Eigen::all, simulated.network.landmarks);
  return anchors;
}

struct SimulateNetwork : OptionVerb<NetworkOptions> {
  std::string output;
  std::string anchors;
  std::string ground_truth;
  std::string labels;

  int run() {
    if (resolve_or_dump()) return kOk;
    options.seed = flags.seed;
    const auto simulated = simulate_network(options);
    const auto& network = simulated.network;
    write_range_csv(output, network);
    if (!anchors.empty()) write_positions(anchors, anchors_of(simulated));
    if (!ground_truth.empty()) write_positions(ground_truth, {network.names, simulated.truth});
    const auto labelled = labels_of(simulated);
    if (!labels.empty()) slam::write_labels(labels, labelled);
    const auto wrong = slam::count(labelled, slam::Label::incorrect);
    say(flags, fmt::format("network: {}, {}, {} up to {:.4f}, {} of them wrong",
                           counted(network.node_count(), "node"),
                           counted(network.landmarks.size(), "anchor"),
                           counted(network.ranges.size(), "range"), simulated.radius, wrong));
    write_json(flags.json, {{"schema", "isotherm.simulate/1"},
                            {"world", "network"},
                            {"nodes", network.node_count()},
                            {"anchors", network.landmarks.size()},
                            {"ranges", network.ranges.size()},
                            {"incorrect", wrong},
                            {"radius", simulated.radius},
                            {"options", options_to_json(options)}});
    return kOk;
  }
};

}  // namespace

Verb add_simulate_network(CLI::App& simulate) {
  auto network = std::make_shared<SimulateNetwork>();
  CLI::App* verb = simulate.add_subcommand("network", "sensors and the distances between them");
  auto& outputs = network->flags.outputs;
  const auto add = [&](const char* flag, std::string& path, const char* help) {
    return outputs.add(*verb, flag, path, help, {".csv"});
  };
  add("-o,--output", network->output, "ranges to write, as CSV (- for stdout)")->required();
  add("--anchor-file", network->anchors, "known positions to write, as CSV");
  add("--ground-truth", network->ground_truth, "all true positions to write, as CSV");
  add("--labels", network->labels, "which ranges are wrong, as CSV");
  network->add_flags(*verb);
  return verb_of(verb, network);
}

}  // namespace isotherm::apps
