#include <string>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "isotherm/base/error.hpp"
#include "modules.hpp"

namespace isotherm::python {
namespace {

// The exception of that name, which Python defines.
nb::object make(const char* name, const std::exception& error) {
  return nb::module_::import_("isotherm.errors").attr(name)(std::string(error.what()));
}

void raise(const nb::object& exception) {
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
}

void raise(const ParseError& error) {
  const nb::object exception = make("ParseError", error);
  exception.attr("path") = error.path();
  exception.attr("line") = error.line();
  exception.attr("column") = error.column();
  exception.attr("token") = nb::steal(PyUnicode_DecodeUTF8(
      error.token().data(), static_cast<Py_ssize_t>(error.token().size()), "replace"));
  raise(exception);
}

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InvalidArgument& error) {
    const nb::object exception = make("InvalidArgument", error);
    exception.attr("option") = error.option();
    raise(exception);
  } catch (const ParseError& error) {
    raise(error);
  } catch (const FileError& error) {
    const nb::object exception = make("FileError", error);
    exception.attr("path") = error.path();
    raise(exception);
  } catch (const NumericalError& error) {
    const nb::object exception = make("NumericalError", error);
    exception.attr("stage") = error.stage();
    raise(exception);
  } catch (const Cancelled& error) {
    raise(make("Cancelled", error));
  } catch (const Error& error) {
    raise(make("Error", error));
  }
}

}  // namespace

void bind_errors() { nb::register_exception_translator(translate); }

}  // namespace isotherm::python
