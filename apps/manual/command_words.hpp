#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

/// What there is to say of the command, taken from its parser.
namespace isotherm::apps {

/// One option of a verb.
struct OptionWords {
  std::vector<std::string> names;    ///< with their dashes; that of what has none
  std::string value;                 ///< "FILE", "a|b|c"; empty for a switch
  std::vector<std::string> choices;  ///< "a", "b", "c"
  std::string help;
  std::string fallback;  ///< or empty
  bool positional = false;
  bool required = false;
};

/// One verb, or a verb below one.
struct VerbWords {
  std::vector<std::string> name;  ///< "simulate", "city"
  std::string summary;
  std::vector<OptionWords> options;
  std::vector<std::string> below;  ///< names of the verbs below
  std::string footer;
};

/// The root, whose name is empty, then every verb in order, each before those below it.
std::vector<VerbWords> words_of(const CLI::App& root);

/// "simulate city"
std::string full_name(const VerbWords& verb);

/// The one of that name, among its fellows. @throws InvalidArgument if there is none
const VerbWords& find_verb(const std::vector<VerbWords>& verbs, const std::string& name);

}  // namespace isotherm::apps
