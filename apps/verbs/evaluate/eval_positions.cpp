#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/geometry/points/point_alignment.hpp"
#include "isotherm/network/io/position_file.hpp"
#include "option_verb.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace network;

struct EvalPositions : OptionVerb<NoOptions> {
  std::string estimate;
  std::string truth;
  std::string leave_out;
  bool align = false;

  int run() {
    if (resolve_or_dump()) return kOk;
    auto [estimated, expected] = common_nodes();
    if (align) estimated = geometry::align_points(estimated, expected).apply(estimated);
    std::vector<double> errors;
    for (Eigen::Index k = 0; k < estimated.cols(); ++k) {
      errors.push_back((estimated.col(k) - expected.col(k)).norm());
    }
    std::sort(errors.begin(), errors.end());
    const auto count = static_cast<double>(errors.size());
    const double rmsd = std::sqrt((estimated - expected).squaredNorm() / count);
    const double median = errors[errors.size() / 2];
    if (flags.json != "-") {
      write_text("-", fmt::format("RMSD {:.6g}  median {:.6g}  max {:.6g}  ({}{})\n", rmsd, median,
                                  errors.back(), counted(errors.size(), "node"),
                                  align ? ", aligned" : ""));
    }
    write_json(flags.json, {{"schema", "isotherm.eval.positions/1"},
                            {"rmsd", rmsd},
                            {"median", median},
                            {"max", errors.back()},
                            {"nodes", errors.size()},
                            {"aligned", align}});
    return kOk;
  }

 private:
  // The positions of the nodes that both files have, in the order of the estimate.
  std::pair<Eigen::MatrixXd, Eigen::MatrixXd> common_nodes() const {
    const auto estimated = read_positions(estimate);
    const auto expected = read_positions(truth);
    if (estimated.dimension() != expected.dimension()) {
      throw InvalidArgument("truth", "has another number of coordinates than the estimate");
    }
    auto column_of = expected.column_of();
    if (!leave_out.empty()) {
      for (const auto& name : read_positions(leave_out).names) column_of.erase(name);
    }
    std::vector<Eigen::Index> from;
    std::vector<Eigen::Index> to;
    for (std::size_t k = 0; k < estimated.names.size(); ++k) {
      const auto found = column_of.find(estimated.names[k]);
      if (found == column_of.end()) continue;
      from.push_back(static_cast<Eigen::Index>(k));
      to.push_back(found->second);
    }
    if (from.empty()) throw InvalidArgument("truth", "has none of the nodes with a position");
    return {estimated.positions(Eigen::all, from), expected.positions(Eigen::all, to)};
  }
};

}  // namespace

Verb add_eval_positions(CLI::App& eval) {
  auto positions = std::make_shared<EvalPositions>();
  CLI::App* verb = eval.add_subcommand("positions", "errors of the positions of nodes");
  verb->add_option("estimate", positions->estimate, "positions written by localize")->required();
  verb->add_option("truth", positions->truth, "true positions, as CSV")->required();
  verb->add_option("--leave-out", positions->leave_out,
                   "positions whose nodes do not count, such as the anchors")
      ->type_name("FILE");
  verb->add_flag("--align", positions->align, "first align by the best isometry");
  positions->add_flags(*verb);
  return verb_of(verb, positions);
}

}  // namespace isotherm::apps
