#include <bit>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "help_formatter.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/spectral/eigen/embed.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "option_verb.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace spectral;

std::string csv_text(const Eigen::MatrixXd& rows, const std::vector<std::uint64_t>& ids) {
  std::string text = "vertex";
  for (Eigen::Index c = 0; c < rows.cols(); ++c) text += fmt::format(",x{}", c);
  text += '\n';
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    append_number(text, ids[static_cast<std::size_t>(r)]);
    for (Eigen::Index c = 0; c < rows.cols(); ++c) {
      text += ',';
      append_number(text, rows(r, c));
    }
    text += '\n';
  }
  return text;
}

// NumPy's format, version 1.0: rows in ascending order of vertex number, column-major.
std::string npy_text(const Eigen::MatrixXd& rows) {
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kPreamble = 10;
  static_assert(std::endian::native == std::endian::little);
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': True, 'shape': ({}, {}), }}",
                                   rows.rows(), rows.cols());
  const std::size_t length = kPreamble + header.size() + 1;
  header.append((kAlignment - length % kAlignment) % kAlignment, ' ');
  header += '\n';
  std::string text("\x93NUMPY\x01\x00", 8);
  text += static_cast<char>(header.size() & 0xff);
  text += static_cast<char>(header.size() >> 8);
  text += header;
  text.append(reinterpret_cast<const char*>(rows.data()),
              static_cast<std::size_t>(rows.size()) * sizeof(double));
  return text;
}

// What each method needs, when it is the one to take, and what it costs.
constexpr std::array<HelpChoice, 3> kEmbeddings = {{
    {"commute-time", "the default: distances are those of resistances, for drawings and search"},
    {"heat", "what is near after the diffusion time --scale; tells components apart"},
    {"eigenmaps", "the eigenvectors themselves, all of one size, for clustering"},
}};

struct EmbedVerb : OptionVerb<EmbedOptions> {
  std::string input;
  std::string output;

  int run() {
    if (resolve_or_dump()) return kOk;
    auto file = read_graph(input, {.strict = flags.strict});
    merge_directions(file, {.strict = flags.strict});
    for (const auto& diagnostic : file.report.diagnostics) warn(flags, to_string(diagnostic));
    const auto result = embed(file.graph, options, progress_line(flags));
    warn_of_lack(result);
    const auto& eigen = result.eigen;
    report(eigen, result.components);
    write_text(output, format_suffix(output) == ".npy" ? npy_text(result.rows)
                                                       : csv_text(result.rows, file.ids));
    write_json(flags.json, to_json(eigen, result.vectors, result.components));
    return eigen.status == EigenStatus::converged ? kOk : kNotConverged;
  }

  void warn_of_lack(const EmbedResult& result) const {
    if (result.available < options.dimensions) {
      warn(flags, fmt::format("the graph has only {}", counted(result.available, "coordinate")));
    }
    const bool several = options.method == Embedding::heat && result.components > 1;
    if (several && options.dimensions < result.components) {
      warn(flags, fmt::format("{} coordinates do not tell {} components apart", options.dimensions,
                              result.components));
    }
    // Vectors of one value are as good as any turn of them, and here some of them are left out.
    if (result.interchangeable > 0) {
      warn(flags, fmt::format("the last {} cannot be told from the next: any other choice of "
                              "vectors with these eigenvalues is as good",
                              counted(result.interchangeable, "coordinate")));
    }
  }

  // Null eigenvalues come first, one a component, whether they were asked for or not.
  Json to_json(const EigenDecomposition& eigen, const VectorBounds& vectors,
               Index components) const {
    const auto left_out = static_cast<std::size_t>(components - eigen.null_count);
    std::vector<double> values(left_out, 0.0);
    std::vector<double> bounds = values;
    std::vector<double> sines = values;
    std::vector<std::size_t> groups(left_out, 0);
    sines.insert(sines.end(), vectors.sines.begin(), vectors.sines.end());
    for (const Index first : vectors.group) {
      groups.push_back(first < eigen.null_count ? 0 : left_out + static_cast<std::size_t>(first));
    }
    values.insert(values.end(), eigen.values.begin(), eigen.values.end());
    bounds.insert(bounds.end(), eigen.bounds.begin(), eigen.bounds.end());
    return {{"schema", "isotherm.embed/1"},
            {"method", enum_name(options.method)},
            {"vertices", eigen.size()},
            {"components", components},
            {"solver", enum_name(eigen.method)},
            {"converged", eigen.status == EigenStatus::converged},
            {"eigenvalues", values},
            {"bounds", bounds},
            {"vector_bounds", sines},
            {"vector_groups", groups},
            {"largest_residual", eigen.count() > 0 ? eigen.residuals.maxCoeff() : 0.0},
            {"orthogonality", eigen.orthogonality},
            {"seconds", eigen.seconds},
            {"options", options_to_json(options)}};
  }

  void report(const EigenDecomposition& eigen, Index components) const {
    say(flags,
        fmt::format("{}: {}, {}, {} by {}, {:.2f} s{}", enum_name(options.method),
                    counted(eigen.size(), "vertex", "vertices"), counted(components, "component"),
                    counted(components - eigen.null_count + eigen.count(), "eigenpair"),
                    enum_name(eigen.method), eigen.seconds,
                    eigen.status == EigenStatus::converged ? "" : "; not converged"));
  }
};

}  // namespace

Verb add_embed(CLI::App& root) {
  auto embed = std::make_shared<EmbedVerb>();
  CLI::App* verb = root.add_subcommand("embed", "give the vertices of a graph coordinates");
  verb->add_option("input", embed->input, "edge list or MatrixMarket file (- for stdin)")
      ->required();
  embed->flags.outputs
      .add(*verb, "-o,--output", embed->output,
           "coordinates to write: CSV, or NumPy if named .npy (- for stdout)", {".csv", ".npy"})
      ->required();
  embed->add_flags(*verb);
  verb->footer(help_table("Methods (all cost the same eigenpairs):", kEmbeddings));
  return verb_of(verb, embed);
}

}  // namespace isotherm::apps
