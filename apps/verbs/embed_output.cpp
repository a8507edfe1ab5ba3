#include "verbs/embed_output.hpp"

#include <array>
#include <bit>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "help_formatter.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/base/words.hpp"

namespace isotherm::apps {
namespace {

using namespace spectral;

// What each method needs, when it is the one to take, and what it costs.
constexpr std::array<HelpChoice, 3> kEmbeddings = {{
    {"commute-time", "the default: distances are those of resistances, for drawings and search"},
    {"heat", "what is near after the diffusion time --scale; tells components apart"},
    {"eigenmaps", "the eigenvectors themselves, all of one size, for clustering"},
}};

}  // namespace

std::string embeddings_help() {
  return help_table("Methods (all cost the same eigenpairs):", kEmbeddings);
}

void add_coordinates_output(CLI::App& verb, OutputFlags& outputs, std::string& path) {
  outputs
      .add(verb, "-o,--output", path,
           "coordinates to write: CSV, or NumPy if named .npy (- for stdout)", {".csv", ".npy"})
      ->required();
}

std::string csv_head(Eigen::Index columns) {
  std::string text = "vertex";
  for (Eigen::Index c = 0; c < columns; ++c) text += fmt::format(",x{}", c);
  return text + '\n';
}

std::string csv_rows(const Eigen::MatrixXd& rows, std::span<const std::uint64_t> ids) {
  std::string text;
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

std::string npy_head(std::int64_t rows, Eigen::Index columns) {
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kPreamble = 10;
  static_assert(std::endian::native == std::endian::little);
  std::string header =
      fmt::format("{{'descr': '<f8', 'fortran_order': True, 'shape': ({}, {}), }}", rows, columns);
  const std::size_t length = kPreamble + header.size() + 1;
  header.append((kAlignment - length % kAlignment) % kAlignment, ' ');
  header += '\n';
  std::string text("\x93NUMPY\x01\x00", 8);
  text += static_cast<char>(header.size() & 0xff);
  text += static_cast<char>(header.size() >> 8);
  return text + header;
}

std::string npy_column(const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  std::string text;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    const Eigen::VectorXd column = columns.col(c);
    text.append(reinterpret_cast<const char*>(column.data()),
                static_cast<std::size_t>(column.size()) * sizeof(double));
  }
  return text;
}

void warn_of_lack(const CommonFlags& flags, const EmbedRun& run, const EmbedResult& result) {
  const auto& options = run.options;
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
Json to_json(const EmbedRun& run, const EmbedResult& result) {
  const auto& eigen = result.eigen;
  const auto& vectors = result.vectors;
  const auto left_out = static_cast<std::size_t>(result.components - eigen.null_count);
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
          {"method", enum_name(run.options.method)},
          {"vertices", run.vertex_count},
          {"components", result.components},
          {"solver", run.solver},
          {"converged", eigen.status == EigenStatus::converged},
          {"eigenvalues", values},
          {"bounds", bounds},
          {"vector_bounds", sines},
          {"vector_groups", groups},
          {"largest_residual", eigen.count() > 0 ? eigen.residuals.maxCoeff() : 0.0},
          {"orthogonality", eigen.orthogonality},
          {"seconds", eigen.seconds},
          {"options", options_to_json(run.options)}};
}

std::string summary(const EmbedRun& run, const EmbedResult& result) {
  const auto& eigen = result.eigen;
  return fmt::format(
      "{}: {}, {}, {} by {}, {:.2f} s{}", enum_name(run.options.method),
      counted(run.vertex_count, "vertex", "vertices"), counted(result.components, "component"),
      counted(result.components - eigen.null_count + eigen.count(), "eigenpair"), run.solver,
      eigen.seconds, eigen.status == EigenStatus::converged ? "" : "; not converged");
}

}  // namespace isotherm::apps
