#include "suggestions.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "isotherm/base/words.hpp"

namespace isotherm::apps {
namespace {

std::vector<const CLI::App*> verbs_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> names_of(const std::vector<const CLI::App*>& verbs) {
  std::vector<std::string> names;
  for (const auto* verb : verbs) names.push_back(verb->get_name());
  return names;
}

std::vector<std::string> flags_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* option : app.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string with_suggestion(const std::string& problem, const std::string& nearest) {
  return nearest.empty() ? problem + " (see --help)"
                         : fmt::format("{}; did you mean {}?", problem, nearest);
}

}  // namespace

std::vector<std::string> command_words(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && words.front() == "help") {
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  return words;
}

std::string what_was_meant(const CLI::App& root, const std::vector<std::string>& words) {
  const CLI::App* app = &root;
  std::size_t next = 0;
  while (next < words.size()) {
    const auto verbs = verbs_of(*app);
    if (verbs.empty() || words[next].starts_with('-')) break;
    const auto verb = std::find_if(verbs.begin(), verbs.end(), [&](const CLI::App* one) {
      return one->get_name() == words[next];
    });
    if (verb == verbs.end()) {
      const std::string who = app == &root ? "there is" : app->get_name() + " has";
      return with_suggestion(fmt::format("{} no verb '{}'", who, words[next]),
                             nearest_word(words[next], names_of(verbs)));
    }
    app = *verb;
    ++next;
  }
  for (; next < words.size(); ++next) {
    const auto& word = words[next];
    if (word == "--") break;
    if (!word.starts_with("--")) continue;
    const auto name = word.substr(0, word.find('='));
    if (app->get_option_no_throw(name) != nullptr) continue;
    const auto problem = fmt::format("{} has no flag {}", app->get_name(), name);
    const auto flag = nearest_word(name, flags_of(*app));
    const auto verb = nearest_word(name.substr(2), names_of(verbs_of(root)));
    // A step of its own is often taken for a flag.
    if (flag.empty() && !verb.empty()) return with_suggestion(problem, "the verb " + verb);
    return with_suggestion(problem, flag);
  }
  return {};
}

}  // namespace isotherm::apps
