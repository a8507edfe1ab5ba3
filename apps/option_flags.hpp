#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"

/// Command-line flags and JSON configuration, both made from the one list of
/// fields an options aggregate gives through visit_fields.
namespace isotherm::apps {

using Json = nlohmann::ordered_json;

namespace detail {

template <class T>
concept Enumeration = std::is_enum_v<T>;

inline std::string flag_name(std::string_view field) {
  std::string flag = "--" + std::string(field);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

template <class T>
Json field_to_json(const T& value) {
  if constexpr (Enumeration<T>) {
    return std::string(enum_name(value));
  } else {
    return value;
  }
}

// The default as help shows it: lists without brackets, names without quotes.
template <class T>
std::string shown(const T& value) {
  const std::string json = field_to_json(value).dump();
  const bool enclosed = json.starts_with('[') || json.starts_with('"');
  return enclosed ? json.substr(1, json.size() - 2) : json;
}

// Whether the value is of the field's type as it stands: nothing is rounded or wrapped.
template <class T>
bool fits(const Json& json) {
  if constexpr (std::same_as<T, bool>) {
    return json.is_boolean();
  } else if constexpr (std::integral<T>) {
    if (json.is_number_unsigned()) return std::in_range<T>(json.get<std::uint64_t>());
    return json.is_number_integer() && std::in_range<T>(json.get<std::int64_t>());
  } else if constexpr (std::floating_point<T>) {
    return json.is_number();
  } else if constexpr (Enumeration<T> || std::same_as<T, std::string>) {
    return json.is_string();
  } else {
    return json.is_array() && std::all_of(json.begin(), json.end(), [](const Json& entry) {
             return fits<typename T::value_type>(entry);
           });
  }
}

template <class T>
void field_from_json(std::string_view field, const Json& json, T& value) {
  if (!fits<T>(json)) {
    throw InvalidArgument(std::string(field),
                          "has the wrong type in the configuration: " + json.dump());
  }
  if constexpr (Enumeration<T>) {
    value = enum_value<T>(field, json.get<std::string>());
  } else {
    value = json.get<T>();
  }
}

template <class T>
struct PlainNumber {
  using type = T;
};
template <class T>
struct PlainNumber<std::optional<T>> {
  using type = T;
};

// A field that is a number, or a list of them, states its range.
template <class T, class... Given>
constexpr bool has_range_if_number() {
  constexpr bool kSwitch = std::same_as<T, bool>;
  constexpr bool kName = Enumeration<T> || std::same_as<T, std::string>;
  return kSwitch || kName || sizeof...(Given) == 1;
}

inline std::string with_range(std::string_view help) { return std::string(help); }
inline std::string with_range(std::string_view help, const Range& range) {
  return std::string(help) + "; in " + to_string(range);
}

/// Adds the flag of a field to `app`; `remember` is called with each value given.
template <class T, class Remember, class... Given>
CLI::Option* add_field_flag(CLI::App& app, std::string_view name, const T& value,
                            const Remember& remember, std::string_view meaning,
                            const Given&... range) {
  static_assert(has_range_if_number<T, Given...>(), "a number without a range");
  const std::string help = with_range(meaning, range...);
  const std::string flag = flag_name(name);
  CLI::Option* option = nullptr;
  if constexpr (std::same_as<T, bool>) {
    // "--x" and "--no-x", so that a configuration can be overridden either way.
    const std::string both = flag + ",!--no-" + flag.substr(2);
    option = app.add_flag_function(
        both, [remember](std::int64_t times) { remember(times > 0); }, help);
  } else if constexpr (Enumeration<T>) {
    option = app.add_option_function<std::string>(
        flag, [remember, flag](const std::string& text) { remember(enum_value<T>(flag, text)); },
        help);
    option->type_name(joined_enum_names<T>());
    option->default_str(shown(value));
  } else {
    option = app.add_option_function<T>(flag, remember, help);
    option->default_str(shown(value));
    if constexpr (!std::is_arithmetic_v<T> && !std::same_as<T, std::string>) {
      option->delimiter(',');
    }
  }
  return option;
}

/// Gives the field `key` of `options` its value, which may be out of range; false if there is no
/// such field. @throws InvalidArgument for a value of the wrong type
template <class Options>
bool assign_field(Options& options, std::string_view key, const Json& json) {
  bool known = false;
  visit_fields(options, [&](std::string_view name, auto& value, std::string_view, const auto&...) {
    if (name != key) return;
    field_from_json(name, json, value);
    known = true;
  });
  return known;
}

/// The same, but @throws InvalidArgument also for a value out of range
template <class Options>
bool take_field(Options& options, std::string_view key, const Json& json) {
  if (!assign_field(options, key, json)) return false;
  require_fields_in_range(options);
  return true;
}

}  // namespace detail

/// A flag for a number, or an optional one, that is no field of an options aggregate.
/// @throws InvalidArgument when a value is given that is out of range
template <class Number>
CLI::Option* add_number(CLI::App& verb, const std::string& flag, Number& value,
                        std::string_view help, const Range& range) {
  using Plain = typename detail::PlainNumber<Number>::type;
  const auto take = [&value, flag, range](const Plain& given) {
    require_in_range(flag, given, range);
    value = given;
  };
  return verb.add_option_function<Plain>(flag, take, detail::with_range(help, range));
}

/// The fields of `options` as a JSON object.
template <class Options>
Json options_to_json(const Options& options) {
  Json json = Json::object();
  visit_fields(options,
               [&json](std::string_view name, const auto& value, std::string_view, const auto&...) {
                 json[std::string(name)] = detail::field_to_json(value);
               });
  return json;
}

/// Options that take their values from defaults, then a configuration, then
/// flags, whatever the order in which these are read.
template <class Options>
class FlaggedOptions {
 public:
  /// Adds one flag a field to `app`; both must outlive this object.
  FlaggedOptions(CLI::App& app, Options& options) : options_(options) {
    visit_fields(options_,
                 [this, &app](std::string_view name, auto& value, std::string_view help,
                              const auto&... range) { add(app, name, value, help, range...); });
  }

  /// Overwrites fields with those of `config`, then with the flags that were
  /// given.
  /// @throws InvalidArgument for an unknown key, or a value of the wrong type or out of range
  void resolve(const Json& config) {
    for (const auto& [key, value] : config.items()) {
      if (detail::take_field(options_, key, value)) continue;
      throw InvalidArgument(key, "is not an option of this command");
    }
    for (const auto& set : given_) set();
    require_fields_in_range(options_);
  }

 private:
  template <class T, class... Given>
  void add(CLI::App& app, std::string_view name, T& value, std::string_view help,
           const Given&... range) {
    const auto remember = [this, &value](const T& given) {
      given_.push_back([&value, given] { value = given; });
    };
    detail::add_field_flag(app, name, value, remember, help, range...)->group("Method");
  }

  Options& options_;
  std::vector<std::function<void()>> given_;
};

}  // namespace isotherm::apps
