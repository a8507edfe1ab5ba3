#include <memory>
#include <string>

#include "manual/completion.hpp"
#include "manual/man_page.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {

Verb add_completion(CLI::App& root) {
  const auto shell = std::make_shared<Shell>(Shell::bash);
  CLI::App* verb = root.add_subcommand("completion", "print a script by which a shell completes");
  verb->add_option_function<std::string>(
          "shell", [shell](const std::string& name) { *shell = enum_value<Shell>("shell", name); },
          "whose script it is")
      ->type_name(joined_enum_names<Shell>())
      ->required();
  return {verb, [&root, shell] {
            write_text("-", completion_script(*shell, words_of(root)));
            return kOk;
          }};
}

Verb add_manual(CLI::App& root) {
  const auto name = std::make_shared<std::string>();
  CLI::App* verb = root.add_subcommand("manual", "print a manual page, for man -l -");
  verb->add_option("verb", *name, "verb that it is of; none: that of the command");
  return {verb, [&root, name] {
            write_text("-", man_page(words_of(root), *name));
            return kOk;
          }};
}

}  // namespace isotherm::apps
