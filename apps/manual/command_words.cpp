#include "manual/command_words.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/text_reader.hpp"

namespace isotherm::apps {
namespace {

OptionWords words_of(const CLI::Option& option) {
  OptionWords words;
  for (const auto& name : option.get_snames()) words.names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) words.names.push_back("--" + name);
  words.positional = option.get_positional();
  if (words.names.empty()) words.names.push_back(option.get_name(true));
  // Switches have no type; CLI11 calls what has no better name TEXT.
  words.value = option.get_type_name() == "TEXT" ? "VALUE" : option.get_type_name();
  if (words.value.find('|') != std::string::npos) {
    for (const auto choice : split(words.value, "|")) words.choices.emplace_back(choice);
  }
  words.help = option.get_description();
  words.fallback = option.get_default_str() == "\"\"" ? "" : option.get_default_str();
  words.required = option.get_required();
  return words;
}

void add_words(const CLI::App& app, std::vector<std::string> name, std::vector<VerbWords>& all) {
  VerbWords words{name, app.get_description(), {}, {}, app.get_footer()};
  for (const auto* option : app.get_options()) words.options.push_back(words_of(*option));
  const auto below = app.get_subcommands([](const CLI::App*) { return true; });
  for (const auto* verb : below) words.below.push_back(verb->get_name());
  all.push_back(std::move(words));
  for (const auto* verb : below) {
    auto longer = name;
    longer.push_back(verb->get_name());
    add_words(*verb, std::move(longer), all);
  }
}

}  // namespace

std::vector<VerbWords> words_of(const CLI::App& root) {
  std::vector<VerbWords> all;
  add_words(root, {}, all);
  return all;
}

std::string full_name(const VerbWords& verb) {
  return fmt::format("{}", fmt::join(verb.name, " "));
}

const VerbWords& find_verb(const std::vector<VerbWords>& verbs, const std::string& name) {
  const auto found = std::find_if(verbs.begin(), verbs.end(), [&name](const VerbWords& verb) {
    return full_name(verb) == name;
  });
  if (found == verbs.end()) throw InvalidArgument("verb", "there is no '" + name + "'");
  return *found;
}

}  // namespace isotherm::apps
