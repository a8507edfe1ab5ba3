#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::apps {

/// The flags of `prune` that choose a method and set its options. Every option of every
/// method has a flag; help shows those of the method that is named beside it.
class PruneFlags {
 public:
  /// This object must outlive `verb`.
  void add_to(CLI::App& verb);

  /// The method that was chosen, with options from its defaults or the preset, then from the
  /// configuration, then from the flags. A configuration may hold options of several methods.
  /// @throws InvalidArgument for a flag or preset of another method, and for unknown keys or
  ///   values of the wrong type in the configuration
  slam::PruneOptions resolve(const Json& config) const;

 private:
  void add_fields_of(CLI::App& verb, const slam::PruneOptions& method);
  void show_only(const slam::PruneOptions& method);
  slam::PruneOptions start(const Json& config) const;

  std::string method_;
  std::string preset_;
  std::map<std::string, CLI::Option*, std::less<>> fields_;  // by name
  std::vector<std::pair<std::string, Json>> given_;
};

}  // namespace isotherm::apps
