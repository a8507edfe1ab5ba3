#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "command.hpp"
#include "isotherm/spectral/eigen/embed.hpp"

/// What `embed` says and writes, on one machine and on many.
namespace isotherm::apps {

/// What was asked for, and of which graph.
struct EmbedRun {
  const spectral::EmbedOptions& options;
  std::int64_t vertex_count = 0;
  std::string_view solver;
};

/// The methods with what each needs, for the end of help.
std::string embeddings_help();

/// The flag that names the file of coordinates, which must be given.
void add_coordinates_output(CLI::App& verb, OutputFlags& outputs, std::string& path);

/// CSV: the line of names, and a row a vertex.
std::string csv_head(Eigen::Index columns);
std::string csv_rows(const Eigen::MatrixXd& rows, std::span<const std::uint64_t> ids);

/// NumPy's format, version 1.0: rows in ascending order of vertex number, column after column.
std::string npy_head(std::int64_t rows, Eigen::Index columns);
std::string npy_column(const Eigen::Ref<const Eigen::MatrixXd>& columns);

void warn_of_lack(const CommonFlags& flags, const EmbedRun& run,
                  const spectral::EmbedResult& result);
Json to_json(const EmbedRun& run, const spectral::EmbedResult& result);
std::string summary(const EmbedRun& run, const spectral::EmbedResult& result);

}  // namespace isotherm::apps
