#pragma once

#include <string>
#include <vector>

#include "command.hpp"
#include "report/report.hpp"

namespace isotherm::apps {

/// The flags by which a verb explains its run.
struct ReportFlags {
  std::string report;  ///< path of the page, or of the document if it ends in .json
  std::string svg;     ///< path of the picture

  void add_to(CLI::App& verb, OutputFlags& outputs);
  bool wanted() const { return !report.empty() || !svg.empty(); }

  /// @throws InvalidArgument naming `flag`, which serves reports only, if there is none
  void require_wanted(const std::string& flag) const;
};

/// Writes what the flags ask for.
/// @throws FileError
void write_report(const ReportFlags& flags, const Report& report);

/// Writes the document itself, or the page that shows it, by the suffix of `path`.
/// @throws FileError
void write_report_document(const std::string& path, const Json& document);

/// The last part of a path, as people call a file; "standard input" for "-".
std::string file_title(const std::string& path);

/// The same of several.
std::string files_title(const std::vector<std::string>& paths);

}  // namespace isotherm::apps
