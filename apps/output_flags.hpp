#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace isotherm::apps {

/// The files that a verb writes, as its flags name them.
class OutputFlags {
 public:
  /// Adds a flag that names a file. It can have the formats that go with `suffixes`, of which
  /// the first is written where the name tells none. With no suffixes all names will do.
  /// `path` must outlive this object.
  CLI::Option* add(CLI::App& verb, const std::string& names, std::string& path,
                   const std::string& help, std::vector<std::string_view> suffixes);

  /// To be called before any work.
  /// @throws InvalidArgument for an empty name, one that promises a format which is not
  ///   written, and two of one file; FileError where a file could not be written
  void check() const;

 private:
  struct Output {
    CLI::Option* option;
    const std::string* path;
    std::vector<std::string_view> suffixes;

    std::string name() const { return option->get_name(); }
  };

  void check_distinct() const;
  std::vector<const Output*> given() const;

  std::vector<Output> outputs_;
};

/// The last suffix of a name, such as ".g2o", but for ".gz", which plays no part.
std::string format_suffix(const std::string& path);

/// @throws InvalidArgument naming `option` if the name of `path` promises a format of ours that
///   is none of `written`
void require_suffix(const std::string& option, const std::string& path,
                    const std::vector<std::string_view>& written);

}  // namespace isotherm::apps
