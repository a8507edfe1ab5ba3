#include "keywords.hpp"

#include <cmath>

#include <nanobind/stl/string.h>

#include "isotherm/base/text_writer.hpp"
#include "isotherm/base/words.hpp"

namespace isotherm::python {
namespace detail {

void wrong_type(std::string_view name, std::string_view wanted, nb::handle value) {
  throw nb::type_error((std::string(name) + ": expected " + std::string(wanted) + ", got " +
                        nb::cast<std::string>(nb::repr(value)))
                           .c_str());
}

namespace {

bool is_bool(nb::handle value) {
  if (PyBool_Check(value.ptr())) return true;
  const auto name = nb::cast<std::string>(nb::handle(value.type()).attr("__name__"));
  const auto home = nb::cast<std::string>(nb::handle(value.type()).attr("__module__"));
  return home == "numpy" && (name == "bool" || name == "bool_");
}

}  // namespace

bool bool_from(std::string_view name, nb::handle value) {
  if (!is_bool(value)) wrong_type(name, "True or False", value);
  return PyObject_IsTrue(value.ptr()) == 1;
}

long long integer_from(std::string_view name, nb::handle value, long long low, long long high) {
  if (is_bool(value) || !PyIndex_Check(value.ptr())) wrong_type(name, "an integer", value);
  const nb::object index = nb::steal(PyNumber_Index(value.ptr()));
  if (!index.is_valid()) throw nb::python_error();
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
  if (overflow != 0 || number < low || number > high) {
    throw InvalidArgument(std::string(name),
                          "is out of range: " + nb::cast<std::string>(nb::str(value)));
  }
  return number;
}

double number_from(std::string_view name, nb::handle value) {
  const bool numeric =
      PyFloat_Check(value.ptr()) || PyIndex_Check(value.ptr()) || nb::hasattr(value, "__float__");
  if (is_bool(value) || !numeric) wrong_type(name, "a number", value);
  const double number = PyFloat_AsDouble(value.ptr());
  if (number == -1.0 && PyErr_Occurred() != nullptr) throw nb::python_error();
  return number;
}

std::string text_from(std::string_view name, nb::handle value) {
  if (!PyUnicode_Check(value.ptr())) wrong_type(name, "a string", value);
  return nb::cast<std::string>(value);
}

std::string text(bool value) { return value ? "True" : "False"; }

std::string text(double value) {
  const std::string number = format_number(value);
  return number.find_first_of(".en") == std::string::npos ? number + ".0" : number;
}

std::string text(const std::string& value) { return "'" + value + "'"; }

std::string text(const std::vector<double>& values) {
  std::string list;
  for (const double value : values) list += (list.empty() ? "" : ", ") + text(value);
  return "[" + list + "]";
}

}  // namespace detail

Keywords::Keywords(std::string function, nb::kwargs given)
    : function_(std::move(function)), given_(nb::dict(given)) {}

nb::object Keywords::take(std::string_view name) {
  const nb::str key(name.data(), name.size());
  if (!given_.contains(key)) return nb::none();
  nb::object value = given_[key];
  nb::del(given_[key]);
  return value;
}

RunKeywords Keywords::take_run() {
  RunKeywords run;
  take_into("threads", run.threads);
  require_in_range("threads", run.threads, closed(0, 1e6));
  take_into("seed", run.seed);
  known_.emplace_back("progress");
  run.progress = take("progress");
  if (!run.progress.is_none() && !PyCallable_Check(run.progress.ptr())) {
    detail::wrong_type("progress", "a function", run.progress);
  }
  return run;
}

std::vector<std::string> Keywords::left() const {
  std::vector<std::string> names;
  for (const auto& [name, value] : given_) names.push_back(nb::cast<std::string>(name));
  return names;
}

void Keywords::finish() const {
  const auto names = left();
  if (names.empty()) return;
  std::string problem = function_ + "() has no keyword '" + names.front() + "'";
  const auto meant = nearest_word(names.front(), known_);
  if (!meant.empty()) problem += "; did you mean '" + meant + "'?";
  throw nb::type_error(problem.c_str());
}

std::vector<KeywordText> run_keywords(RunTexts last) {
  std::vector<KeywordText> texts = {
      {"progress", "collections.abc.Callable[[str, int, int], object] | None", "None",
       "called now and then with a stage, how much of it is done and how much there is (0 where "
       "that is not known); returning False raises Cancelled"}};
  if (last >= RunTexts::threads) {
    texts.push_back({"threads", "int", "0", "at most so many; 0: all cores; results are the same"});
  }
  if (last >= RunTexts::seed) {
    texts.push_back({"seed", "int", "0", "of the random choices, where there are some"});
  }
  return texts;
}

std::string signature(const std::string& name, const std::string& arguments,
                      const std::vector<KeywordText>& keywords, const std::string& result) {
  std::string text = "def " + name + "(" + arguments + (arguments.empty() ? "*" : ", *");
  for (const auto& keyword : keywords) {
    text += ", " + keyword.name + ": " + keyword.type + " = " + keyword.fallback;
  }
  return text + ") -> " + result;
}

std::string documentation(const std::string& summary, const std::vector<KeywordText>& keywords) {
  std::string text = summary + "\n\nKeyword Args:\n";
  for (const auto& keyword : keywords) {
    text += "    " + keyword.name + ": " + keyword.help;
    text += " (default " + keyword.fallback + ")\n";
  }
  return text;
}

}  // namespace isotherm::python
