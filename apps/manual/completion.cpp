#include "manual/completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace isotherm::apps {
namespace {

// In single quotes of a shell. What `special` lists gets a backslash besides.
std::string quoted(const std::string& text, const std::string& special = "") {
  std::string safe = "'";
  for (const char c : text) {
    if (special.find(c) != std::string::npos) safe += '\\';
    safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return safe + "'";
}

std::string spaced(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

// Sets `verb` to the verb that the words before the cursor name, in bash and zsh.
std::string verb_so_far(const std::vector<VerbWords>& verbs, const std::string& words) {
  std::string text = "  local verb='' word\n  for word in " + words + "; do\n";
  text += "    case \"$verb $word\" in\n";
  for (const auto& verb : verbs) {
    if (verb.name.empty()) continue;
    const std::string space = verb.name.size() == 1 ? " " : "";
    text += fmt::format("      {}) verb={} ;;\n", quoted(space + full_name(verb)),
                        quoted(full_name(verb)));
  }
  return text + "    esac\n  done\n";
}

std::vector<std::string> flags_of(const VerbWords& verb) {
  std::vector<std::string> flags;
  for (const auto& option : verb.options) {
    if (option.names.front().starts_with('-')) {
      flags.insert(flags.end(), option.names.begin(), option.names.end());
    }
  }
  return flags;
}

// The choices of what has no flag.
std::vector<std::string> positional_choices(const VerbWords& verb) {
  std::vector<std::string> words;
  for (const auto& option : verb.options) {
    if (option.positional) words.insert(words.end(), option.choices.begin(), option.choices.end());
  }
  return words;
}

// What may follow the verb: those below it, or the choices of what has no flag.
std::vector<std::string> words_after(const VerbWords& verb) {
  auto words = positional_choices(verb);
  words.insert(words.begin(), verb.below.begin(), verb.below.end());
  return words;
}

std::string bash_choices(const VerbWords& verb) {
  std::string text;
  for (const auto& option : verb.options) {
    if (option.choices.empty()) continue;
    for (const auto& name : option.names) {
      text += fmt::format("    {}) words={} ;;\n", quoted(full_name(verb) + ":" + name),
                          quoted(spaced(option.choices)));
    }
  }
  return text;
}

std::string bash(const std::vector<VerbWords>& verbs) {
  std::string text = "# Completion of isotherm in bash, made by 'isotherm completion bash'.\n";
  text += "_isotherm() {\n  local current=${COMP_WORDS[COMP_CWORD]} words=''\n";
  text += verb_so_far(verbs, "\"${COMP_WORDS[@]:1:COMP_CWORD-1}\"");
  text += "  case \"$verb:${COMP_WORDS[COMP_CWORD-1]}\" in\n";
  for (const auto& verb : verbs) text += bash_choices(verb);
  text += "  esac\n  if [ -z \"$words\" ]; then\n    case \"$verb:$current\" in\n";
  for (const auto& verb : verbs) {
    const std::string name = full_name(verb);
    text += fmt::format("      {}*) words={} ;;\n", quoted(name + ":-"),
                        quoted(spaced(flags_of(verb))));
    const auto after = words_after(verb);
    if (after.empty()) continue;
    text += fmt::format("      {}*) words={} ;;\n", quoted(name + ":"), quoted(spaced(after)));
  }
  text += "    esac\n  fi\n";
  text += "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n}\n";
  return text + "complete -o bashdefault -o default -F _isotherm isotherm\n";
}

// What has a meaning of its own in an explanation of zsh.
constexpr const char* kZshSpecial = ":\\[]";

// What completes a value, or a word without a flag.
std::string zsh_values(const std::vector<std::string>& choices) {
  return choices.empty() ? "_files" : quoted("(" + spaced(choices) + ")");
}

// One line of _arguments: '(-o --output)'{-o,--output}'[help]:FILE:_files'
std::string zsh_option(const OptionWords& option) {
  std::string text = option.names.front();
  if (option.names.size() > 1) {
    text = fmt::format("'({})'{{{}}}", fmt::join(option.names, " "), fmt::join(option.names, ","));
  }
  text += "'['" + quoted(option.help, kZshSpecial) + "']'";
  if (option.value.empty()) return text;
  return text + (option.choices.empty() ? ":value:" : ":choice:") + zsh_values(option.choices);
}

std::string zsh_verb(const VerbWords& verb, const std::vector<VerbWords>& verbs) {
  std::string text = fmt::format("    {})\n", quoted(full_name(verb)));
  if (!verb.below.empty()) {
    text += "      _values verb";
    for (const auto& name : verb.below) {
      const std::string whole = verb.name.empty() ? name : full_name(verb) + " " + name;
      text += " \\\n        " + quoted(name) + "'['" +
              quoted(find_verb(verbs, whole).summary, kZshSpecial) + "']'";
    }
    return text + " ;;\n";
  }
  text += "      _arguments";
  for (const auto& option : verb.options) {
    if (!option.names.front().starts_with('-')) continue;
    text += " \\\n        " + zsh_option(option);
  }
  return text + " \\\n        '*:word:'" + zsh_values(positional_choices(verb)) + " ;;\n";
}

std::string zsh(const std::vector<VerbWords>& verbs) {
  std::string text = "#compdef isotherm\n";
  text += "# Completion of isotherm in zsh, made by 'isotherm completion zsh'.\n_isotherm() {\n";
  text += verb_so_far(verbs, "${words[2,CURRENT-1]}");
  text += "  case \"$verb\" in\n";
  for (const auto& verb : verbs) text += zsh_verb(verb, verbs);
  return text + "  esac\n}\n_isotherm \"$@\"\n";
}

// The test that `verb` is the one so far.
std::string fish_condition(const VerbWords& verb) {
  if (verb.name.empty()) return "__fish_use_subcommand";
  std::vector<std::string> tests;
  for (const auto& name : verb.name) tests.push_back("__fish_seen_subcommand_from " + name);
  if (!verb.below.empty()) {
    tests.push_back(fmt::format("not __fish_seen_subcommand_from {}", fmt::join(verb.below, " ")));
  }
  return fmt::format("{}", fmt::join(tests, "; and "));
}

std::string fish_option(const VerbWords& verb, const OptionWords& option) {
  std::string text = "complete -c isotherm -n " + quoted(fish_condition(verb), "\\");
  for (const auto& name : option.names) {
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (!option.choices.empty()) {
    text += " -x -a " + quoted(spaced(option.choices), "\\");
  } else if (!option.value.empty()) {
    text += " -r";
  }
  return text + " -d " + quoted(option.help, "\\") + "\n";
}

// The line for what has no flag, if it is one of some words.
std::string fish_positional(const VerbWords& verb) {
  const auto choices = positional_choices(verb);
  if (choices.empty()) return {};
  return fmt::format("complete -c isotherm -f -n {} -a {}\n", quoted(fish_condition(verb), "\\"),
                     quoted(spaced(choices), "\\"));
}

std::string fish(const std::vector<VerbWords>& verbs) {
  std::string text = "# Completion of isotherm in fish, made by 'isotherm completion fish'.\n";
  for (const auto& verb : verbs) {
    for (const auto& name : verb.below) {
      const std::string whole = verb.name.empty() ? name : full_name(verb) + " " + name;
      text += fmt::format("complete -c isotherm -f -n {} -a {} -d {}\n",
                          quoted(fish_condition(verb), "\\"), name,
                          quoted(find_verb(verbs, whole).summary, "\\"));
    }
    text += fish_positional(verb);
    for (const auto& option : verb.options) {
      if (option.names.front().starts_with('-')) text += fish_option(verb, option);
    }
  }
  return text;
}

}  // namespace

std::string completion_script(Shell shell, const std::vector<VerbWords>& verbs) {
  switch (shell) {
    case Shell::bash:
      return bash(verbs);
    case Shell::zsh:
      return zsh(verbs);
    case Shell::fish:
      return fish(verbs);
  }
  return {};
}

}  // namespace isotherm::apps
