#pragma once

#include <concepts>
#include <optional>
#include <type_traits>

#include "command.hpp"

namespace isotherm::apps {

/// The options of a verb that has none of its own.
struct NoOptions {
  void validate() const {}
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, NoOptions>
void visit_fields(Options&, Visitor&&) {}

/// What every verb with an options aggregate has in common: its flags, the
/// configuration file, and --dump-config.
template <class Options>
struct OptionVerb {
  CommonFlags flags;
  Options options;

  /// Adds one flag a field of the options, and the common flags.
  void add_flags(CLI::App& verb) {
    flagged_.emplace(verb, options);
    add_common_flags(verb, flags);
  }

  /// Brings the options into force. True if they were only to be printed, which is
  /// then done.
  /// @throws FileError, ParseError, InvalidArgument for options out of range
  bool resolve_or_dump() {
    flagged_->resolve(read_config(flags));
    if (flags.dump_config) {
      write_json("-", options_to_json(options));
    } else {
      options.validate();
    }
    return flags.dump_config;
  }

 private:
  std::optional<FlaggedOptions<Options>> flagged_;
};

}  // namespace isotherm::apps
