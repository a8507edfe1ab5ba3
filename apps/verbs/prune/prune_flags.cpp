#include "verbs/prune/prune_flags.hpp"

#include <array>
#include <concepts>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "help_formatter.hpp"
#include "isotherm/base/error.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

// Options under a name, which belong to one method.
struct Preset {
  std::string name;
  PruneOptions options;
  std::string help;
};

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = {
      {"datta2016", slam::datta2016(), "heat as Datta et al. (2016) state it"}};
  return all;
}

const Preset& preset_of(const std::string& name) {
  for (const auto& preset : presets()) {
    if (preset.name == name) return preset;
  }
  throw InvalidArgument("preset", "there is none called '" + name + "'");
}

// What each method needs, when it is the one to take, and what it costs.
constexpr std::array<HelpChoice, 10> kUses = {{
    {"consensus",
     "the default: the loops that explain all measurements best, and a probability for "
     "each. Needs information that can be used; some factorisations a move"},
    {"heat",
     "the shape of the graph decides, also where information is missing or wrong. Needs "
     "many loops; a sparse factorisation a scale"},
    {"chi2",
     "each loop against odometry alone: quickest, but only where odometry drifts no "
     "further than it says"},
    {"lap-line",
     "compares the curves of the path at both ends of a loop. Needs paths driven "
     "again, no information; quick"},
    {"rrr",
     "loops in groups that agree over time. Needs places seen repeatedly; an optimisation "
     "a group"},
    {"pcm", "the largest set of loops that agree in pairs. Up to some thousand loops"},
    {"sc", "switchable constraints: one optimisation in which loops can be turned off"},
    {"dcs", "the same without switches. Needs odometry that is nearly right"},
    {"cauchy", "one optimisation under a kernel with heavy tails. Few false loops only"},
    {"gnc", "graduated non-convexity: some ten optimisations. Many false loops"},
}};

bool take(PruneOptions& options, std::string_view key, const Json& value) {
  return std::visit([&](auto& own) { return detail::take_field(own, key, value); }, options);
}

// The names of the methods that have the option, checking that the value is of its type. Its
// range may be another one for each.
std::vector<std::string> owners(std::string_view key, const Json& value) {
  std::vector<std::string> names;
  for (auto& method : prune_methods()) {
    const bool known =
        std::visit([&](auto& own) { return detail::assign_field(own, key, value); }, method);
    if (known) names.emplace_back(method_name(method));
  }
  return names;
}

std::string names_of_methods(std::string_view separator) {
  std::vector<std::string_view> names;
  const auto methods = prune_methods();
  for (const auto& method : methods) names.push_back(method_name(method));
  return fmt::format("{}", fmt::join(names, separator));
}

}  // namespace

void PruneFlags::add_to(CLI::App& verb) {
  verb.add_option_function<std::string>(
          "--method",
          [this](const std::string& name) {
            show_only(prune_method(name));
            method_ = name;
          },
          "how false loop closures are found; with --help: what it can be told")
      ->type_name(names_of_methods("|"))
      ->default_str(std::string(method_name({})));
  std::string described;
  for (const auto& preset : presets()) described += preset.name + ": " + preset.help;
  verb.add_option_function<std::string>(
          "--preset",
          [this](const std::string& name) {
            show_only(preset_of(name).options);
            preset_ = name;
          },
          described)
      ->type_name("NAME");
  for (const auto& method : prune_methods()) add_fields_of(verb, method);
  verb.footer(help_table("Methods:", kUses) +
              "Each method has options of its own: isotherm prune --method NAME --help");
}

void PruneFlags::add_fields_of(CLI::App& verb, const PruneOptions& method) {
  const auto add = [&](std::string_view field, const auto& value, std::string_view help,
                       const auto&... range) {
    std::string name(field);
    if (fields_.contains(name)) return;  // another method has it too
    const auto remember = [this, name](const auto& given) {
      given_.emplace_back(name, detail::field_to_json(given));
    };
    fields_[name] = detail::add_field_flag(verb, field, value, remember, help, range...)->group("");
  };
  std::visit([&add](const auto& own) { visit_fields(own, add); }, method);
}

void PruneFlags::show_only(const PruneOptions& method) {
  for (const auto& [name, option] : fields_) option->group("");
  const auto show = [&](std::string_view name, const auto& value, std::string_view help,
                        const auto&... range) {
    CLI::Option* option = fields_.find(name)->second;
    option->group(fmt::format("Method {}", method_name(method)));
    option->description(detail::with_range(help, range...));
    constexpr bool kSwitch = std::same_as<std::remove_cvref_t<decltype(value)>, bool>;
    if constexpr (!kSwitch) option->default_str(detail::shown(value));
  };
  std::visit([&show](const auto& own) { visit_fields(own, show); }, method);
}

PruneOptions PruneFlags::start(const Json& config) const {
  std::string name = method_;
  if (name.empty() && config.contains("method")) {
    detail::field_from_json("method", config["method"], name);
  }
  if (preset_.empty()) return name.empty() ? PruneOptions() : prune_method(name);
  const auto& preset = preset_of(preset_);
  if (!name.empty() && name != method_name(preset.options)) {
    throw InvalidArgument("--preset", fmt::format("{} is of method {}, not of {}", preset_,
                                                  method_name(preset.options), name));
  }
  return preset.options;
}

PruneOptions PruneFlags::resolve(const Json& config) const {
  PruneOptions options = start(config);
  for (const auto& [key, value] : config.items()) {
    if (key == "method" || take(options, key, value)) continue;
    if (owners(key, value).empty()) throw InvalidArgument(key, "is not an option of this command");
  }
  for (const auto& [name, value] : given_) {
    if (take(options, name, value)) continue;
    throw InvalidArgument(detail::flag_name(name),
                          fmt::format("is an option of {}, not of method {}",
                                      fmt::join(owners(name, value), ", "), method_name(options)));
  }
  return options;
}

}  // namespace isotherm::apps
