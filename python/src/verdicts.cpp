#include "verdicts.hpp"

#include <cstddef>
#include <string>

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "isotherm/base/error.hpp"
#include "modules.hpp"

namespace isotherm::python {
namespace {

using namespace nanobind::literals;
using spectral::EdgeVerdict;
using spectral::Verdict;

std::vector<std::string> texts(const Verdicts& verdicts) {
  std::vector<std::string> names;
  for (const auto& row : verdicts.rows) names.emplace_back(enum_name(row.verdict));
  return names;
}

std::vector<std::string> stages(const Verdicts& verdicts) {
  std::vector<std::string> all;
  for (const auto& row : verdicts.rows) all.push_back(row.stage);
  return all;
}

View2<std::uint64_t> ends(const Verdicts& verdicts, nb::handle owner) {
  static_assert(offsetof(EdgeVerdict, to) == offsetof(EdgeVerdict, from) + sizeof(std::uint64_t));
  const std::uint64_t* const first = verdicts.rows.empty() ? nullptr : &verdicts.rows[0].from;
  return strided_rows(first, verdicts.rows.size(), 2, sizeof(EdgeVerdict), owner);
}

nb::ndarray<nb::numpy, bool, nb::shape<-1>> mask(const Verdicts& verdicts, Verdict wanted) {
  auto* const flags = new bool[verdicts.rows.size() + 1];
  nb::capsule owner(flags, [](void* memory) noexcept { delete[] static_cast<bool*>(memory); });
  for (std::size_t k = 0; k < verdicts.rows.size(); ++k) {
    flags[k] = verdicts.rows[k].verdict == wanted;
  }
  return {flags, {verdicts.rows.size()}, owner};
}

nb::dict counts(const Verdicts& verdicts) {
  nb::dict all;
  for (const auto& [verdict, name] : enum_names(Verdict{})) {
    all[nb::str(name.data(), name.size())] = count(verdicts.rows, verdict);
  }
  return all;
}

void bind_decisions(nb::class_<Verdicts>& bound) {
  bound.def("__len__", [](const Verdicts& self) { return self.rows.size(); })
      .def("__repr__", [](const Verdicts& self) { return in_words(self.rows); })
      .def_prop_ro(
          "edge",
          [](const Verdicts& self) {
            return member_view(self.rows, &EdgeVerdict::edge, nb::find(self));
          },
          "Positions among the edges of the input, from 0.")
      .def_prop_ro(
          "ends", [](const Verdicts& self) { return ends(self, nb::find(self)); },
          "The numbers that the input gives to the vertices of each, m x 2.")
      .def_prop_ro("verdict", texts, "'keep', 'prune' or 'ambiguous'.")
      .def_prop_ro(
          "kept", [](const Verdicts& self) { return mask(self, Verdict::keep); },
          nb::rv_policy::automatic, "Which are kept.")
      .def_prop_ro(
          "pruned", [](const Verdicts& self) { return mask(self, Verdict::prune); },
          nb::rv_policy::automatic, "Which are pruned.")
      .def_prop_ro(
          "ambiguous", [](const Verdicts& self) { return mask(self, Verdict::ambiguous); },
          nb::rv_policy::automatic, "Which are proven neither way.");
}

void bind_reasons(nb::class_<Verdicts>& bound) {
  bound
      .def_prop_ro(
          "score",
          [](const Verdicts& self) {
            return member_view(self.rows, &EdgeVerdict::score, nb::find(self));
          },
          "Larger is more suspicious.")
      .def_prop_ro(
          "threshold",
          [](const Verdicts& self) {
            return member_view(self.rows, &EdgeVerdict::threshold, nb::find(self));
          },
          "What the score was compared with.")
      .def_prop_ro("stage", stages, "The scale, round or test that decided.")
      .def_prop_ro(
          "probability",
          [](const Verdicts& self) {
            return member_view(self.rows, &EdgeVerdict::probability, nb::find(self));
          },
          "Of the edge being true, as method consensus states it; nan for others.")
      .def_prop_ro("counts", counts, nb::sig("def counts(self) -> dict[str, int]"),
                   "How many there are of each verdict.")
      .def(
          "write",
          [](const Verdicts& self, nb::handle path) {
            spectral::write_verdicts(path_of(path), self.rows, self.names);
          },
          "path"_a, nb::sig("def write(self, path: str | os.PathLike[str]) -> None"),
          "Write the verdict file that the command writes, as CSV.");
  bind_data_frame(
      bound,
      [](nb::handle_t<Verdicts> self) {
        return data_frame(columns(nb::cast<const Verdicts&>(self), self));
      },
      "The columns of the verdict file");
}

}  // namespace

std::string in_words(const spectral::EdgeVerdicts& rows) {
  std::string text = "Verdicts(" + std::to_string(rows.size());
  for (const auto& [verdict, name] : enum_names(Verdict{})) {
    text += ", " + std::to_string(count(rows, verdict)) + " " + std::string(name);
  }
  return text + ")";
}

nb::dict columns(const Verdicts& verdicts, nb::handle owner) {
  nb::dict all;
  all["edge"] = member_view(verdicts.rows, &EdgeVerdict::edge, owner);
  all["from"] = member_view(verdicts.rows, &EdgeVerdict::from, owner);
  all["to"] = member_view(verdicts.rows, &EdgeVerdict::to, owner);
  all["verdict"] = texts(verdicts);
  all["score"] = member_view(verdicts.rows, &EdgeVerdict::score, owner);
  all["threshold"] = member_view(verdicts.rows, &EdgeVerdict::threshold, owner);
  all["stage"] = stages(verdicts);
  if (state_probabilities(verdicts.rows)) {
    all["probability"] = member_view(verdicts.rows, &EdgeVerdict::probability, owner);
  }
  return all;
}

nb::object data_frame(Verdicts verdicts) {
  const nb::object owner = nb::cast(std::move(verdicts));
  return data_frame(columns(nb::cast<const Verdicts&>(owner), owner));
}

void bind_verdicts(nb::module_& module) {
  nb::class_<Verdicts> bound(
      module, "Verdicts",
      "A decision for each candidate edge, with its reason: column by column, in "
      "the order of the input.");
  bind_decisions(bound);
  bind_reasons(bound);

  module.def(
      "read_verdicts",
      [](nb::handle path) { return Verdicts{spectral::read_verdicts(path_of(path))}; }, "path"_a,
      nb::sig("def read_verdicts(path: str | os.PathLike[str]) -> Verdicts"),
      "Read a verdict file.");
}

}  // namespace isotherm::python
