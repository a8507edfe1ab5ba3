#pragma once

#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>

#include "arrays.hpp"
#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "run.hpp"

/// Keyword arguments made from the fields of options, as flags are: what they are called, what
/// they take, and what documentation and stubs say of them.
namespace isotherm::python {

namespace detail {

/// @throws TypeError "name: expected <wanted>, got <value>"
[[noreturn]] void wrong_type(std::string_view name, std::string_view wanted, nb::handle value);

bool bool_from(std::string_view name, nb::handle value);
long long integer_from(std::string_view name, nb::handle value, long long low, long long high);
double number_from(std::string_view name, nb::handle value);
std::string text_from(std::string_view name, nb::handle value);

template <class T>
void assign(std::string_view name, nb::handle value, T& field) {
  if constexpr (std::same_as<T, bool>) {
    field = bool_from(name, value);
  } else if constexpr (std::is_enum_v<T>) {
    field = enum_value<T>(name, text_from(name, value));
  } else if constexpr (std::integral<T>) {
    using Limits = std::numeric_limits<T>;
    constexpr auto kHigh = static_cast<long long>(std::in_range<long long>(Limits::max())
                                                      ? Limits::max()
                                                      : std::numeric_limits<long long>::max());
    field = static_cast<T>(integer_from(name, value, static_cast<long long>(Limits::min()), kHigh));
  } else if constexpr (std::floating_point<T>) {
    field = number_from(name, value);
  } else if constexpr (std::same_as<T, std::string>) {
    field = text_from(name, value);
  } else {
    field = number_list<typename T::value_type>(value, name);
  }
}

/// A field's type as Python writes it.
template <class T>
std::string type_text() {
  if constexpr (std::same_as<T, bool>) {
    return "bool";
  } else if constexpr (std::is_enum_v<T>) {
    return "typing.Literal['" + joined_enum_names<T>("', '") + "']";
  } else if constexpr (std::integral<T>) {
    return "int";
  } else if constexpr (std::floating_point<T>) {
    return "float";
  } else if constexpr (std::same_as<T, std::string>) {
    return "str";
  } else {
    return "collections.abc.Sequence[float] | numpy.typing.NDArray[numpy.float64]";
  }
}

std::string text(bool value);
std::string text(double value);
std::string text(const std::string& value);
std::string text(const std::vector<double>& values);
template <std::integral Integer>
requires(!std::same_as<Integer, bool>) std::string text(Integer value) {
  return std::to_string(value);
}
template <class Enum>
requires std::is_enum_v<Enum> std::string text(Enum value) {
  return "'" + std::string(enum_name(value)) + "'";
}

}  // namespace detail

/// What Python has of a field's value.
template <class T>
nb::object python_value(const T& value) {
  if constexpr (std::is_enum_v<T>) {
    return nb::cast(std::string(enum_name(value)));
  } else {
    return nb::cast(value);
  }
}

/// The keywords of one call, each of which is taken once.
class Keywords {
 public:
  /// `function` names the call in messages.
  Keywords(std::string function, nb::kwargs given);

  /// The value of `name`, or None; it is then taken.
  nb::object take(std::string_view name);

  /// Gives the fields of `options` the values that were given for them.
  /// @throws TypeError for a value of the wrong type, InvalidArgument for one out of range
  template <class Options>
  void take_fields(Options& options) {
    visit_fields(options,
                 [this](std::string_view name, auto& field, std::string_view, const auto&...) {
                   known_.emplace_back(name);
                   const nb::object value = take(name);
                   if (!value.is_none()) detail::assign(name, value, field);
                 });
    require_fields_in_range(options);
    options.validate();
  }

  /// threads, seed and progress.
  RunKeywords take_run();

  /// A whole number, text or switch that is no field of options.
  template <class T>
  void take_into(std::string_view name, T& value) {
    known_.emplace_back(name);
    const nb::object given = take(name);
    if (!given.is_none()) detail::assign(name, given, value);
  }

  /// What has not been taken.
  std::vector<std::string> left() const;

  /// @throws TypeError naming a keyword that nothing has taken, and what may have been meant
  void finish() const;

 private:
  std::string function_;
  nb::dict given_;
  std::vector<std::string> known_;
};

/// What is written of a keyword in signatures and documentation.
struct KeywordText {
  std::string name;
  std::string type;
  std::string fallback;
  std::string help;
};

/// The keywords that the fields of `options` are, with the defaults that it has.
template <class Options>
std::vector<KeywordText> keywords_of(const Options& options) {
  std::vector<KeywordText> all;
  visit_fields(options, [&all](std::string_view name, const auto& field, std::string_view help,
                               const auto&... range) {
    using T = std::remove_cvref_t<decltype(field)>;
    std::string meaning(help);
    ((meaning += "; in " + to_string(range)), ...);
    all.push_back({std::string(name), detail::type_text<T>(), detail::text(field), meaning});
  });
  return all;
}

/// Which of the keywords of take_run() a call has.
enum class RunTexts { progress, threads, seed };  // each with those before it

std::vector<KeywordText> run_keywords(RunTexts last);
inline std::vector<KeywordText> operator+(std::vector<KeywordText> first,
                                          const std::vector<KeywordText>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// `def name(arguments, *, keywords) -> result`.
std::string signature(const std::string& name, const std::string& arguments,
                      const std::vector<KeywordText>& keywords, const std::string& result);

/// `summary`, below which each keyword has a paragraph.
std::string documentation(const std::string& summary, const std::vector<KeywordText>& keywords);

/// Defines a function of `module` whose keywords are made from options; `function` takes its
/// own arguments, then nb::kwargs.
template <class Function, class... Extra>
void define(nb::module_& module, const char* name, const std::string& arguments,
            const std::vector<KeywordText>& keywords, const std::string& result,
            const std::string& summary, Function&& function, const Extra&... extra) {
  module.def(name, std::forward<Function>(function), extra..., nb::arg("keywords"),
             nb::sig(signature(name, arguments, keywords, result).c_str()),
             documentation(summary, keywords).c_str());
}

}  // namespace isotherm::python
