#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "help_formatter.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/spectral/eigen/embedding.hpp"
#include "isotherm/spectral/eigen/vector_bounds.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "option_verb.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace spectral;

enum class Embedding { commute_time, heat, eigenmaps };

constexpr std::array<EnumName<Embedding>, 3> enum_names(Embedding) {
  return {{{Embedding::commute_time, "commute-time"},
           {Embedding::heat, "heat"},
           {Embedding::eigenmaps, "eigenmaps"}}};
}

struct EmbedOptions {
  Embedding method = Embedding::commute_time;
  // Columns, >= 1. Null eigenvectors have none, but for heat, if there are several.
  std::int64_t dimensions = 2;
  double scale = 1.0;  // diffusion time, for heat; finite, >= 0
  LaplacianKind laplacian = LaplacianKind::combinatorial;

  void validate() const { require_fields_in_range(*this); }
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, EmbedOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("method", options.method, "coordinates to compute");
  visit("dimensions", options.dimensions,
        "number of coordinates; for heat those that tell components apart come first",
        closed(1, 1e6));
  visit("scale", options.scale, "heat: diffusion time", closed(0, 1e12));
  visit("laplacian", options.laplacian, "matrix whose eigenvectors are used");
}

Eigen::MatrixXd coordinates(const EigenDecomposition& eigen, const EmbedOptions& options) {
  switch (options.method) {
    case Embedding::commute_time:
      return commute_time_embedding(eigen);
    case Embedding::heat:
      return heat_embedding(eigen, options.scale);
    case Embedding::eigenmaps:
      return laplacian_eigenmap(eigen);
  }
  throw InvalidArgument("method", "is not an embedding");
}

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
    const Laplacian laplacian(file.graph, options.laplacian);
    const Index components = laplacian.components().count;
    // Heat tells components apart by the null space, in which one component has one point.
    const bool null_vectors = options.method == Embedding::heat && components > 1;
    const Index available = laplacian.size() - (null_vectors ? 0 : components);
    if (available < options.dimensions) {
      warn(flags, fmt::format("the graph has only {}", counted(available, "coordinate")));
    }
    if (null_vectors && options.dimensions < components) {
      warn(flags, fmt::format("{} coordinates do not tell {} components apart", options.dimensions,
                              components));
    }
    EigenOptions eigen_options;
    const auto wanted = static_cast<Index>(
        std::clamp<std::int64_t>(options.dimensions, 1, std::max<Index>(1, available)));
    // The next value tells whether the last vector stands alone.
    const bool complete = available <= wanted;
    eigen_options.count = complete ? wanted : wanted + 1;
    eigen_options.null_vectors = null_vectors;
    eigen_options.progress = progress_line(flags);
    auto eigen = smallest_eigenpairs(laplacian, eigen_options);
    auto vectors = vector_bounds(eigen, complete);
    if (eigen.null_count <= wanted) warn_of_choice(vectors, wanted);
    shorten(eigen, vectors, wanted);
    const auto rows = coordinates(eigen, options);
    report(eigen, components);
    write_text(output, format_suffix(output) == ".npy" ? npy_text(rows) : csv_text(rows, file.ids));
    write_json(flags.json, to_json(eigen, vectors, components));
    return eigen.status == EigenStatus::converged ? kOk : kNotConverged;
  }

  // Vectors of one value are as good as any turn of them, and here some of them are left out.
  void warn_of_choice(const VectorBounds& vectors, Index wanted) const {
    if (static_cast<Index>(vectors.group.size()) <= wanted) return;
    const Index first = vectors.group[static_cast<std::size_t>(wanted)];
    if (first >= wanted) return;
    warn(flags, fmt::format("the last {} cannot be told from the next: any other choice of vectors "
                            "with these eigenvalues is as good",
                            counted(wanted - first, "coordinate")));
  }

  static void shorten(EigenDecomposition& eigen, VectorBounds& vectors, Index count) {
    count = std::min(count, eigen.count());
    eigen.values.conservativeResize(count);
    eigen.vectors.conservativeResize(Eigen::NoChange, count);
    eigen.residuals.conservativeResize(count);
    eigen.bounds.conservativeResize(count);
    vectors.sines.conservativeResize(count);
    vectors.group.resize(static_cast<std::size_t>(count));
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
