#include "report/report_check.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "isotherm/base/error.hpp"
#include "report/base64.hpp"
#include "report/report.hpp"
#include "report/report_json.hpp"

namespace isotherm::apps {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are read as they lie");

// A member of the document and its place in it, which messages name.
class Member {
 public:
  Member(const Json& value, const std::string& path, std::string place)
      : value_(value), path_(path), place_(std::move(place)) {}

  const Json& value() const { return value_; }
  bool has(const char* key) const { return object().contains(key); }

  Member operator[](const char* key) const {
    if (!has(key)) fail(fmt::format("has no member '{}'", key));
    return {value_[key], path_, place_.empty() ? key : place_ + "." + key};
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw ParseError({path_, 0, 0}, "", (place_.empty() ? "the document" : place_) + " " + problem);
  }

  const Json& object() const {
    if (!value_.is_object()) fail("must be an object");
    return value_;
  }
  std::string text() const {
    if (!value_.is_string()) fail("must be a string");
    return value_.get<std::string>();
  }
  std::vector<Member> list() const {
    if (!value_.is_array()) fail("must be a list");
    std::vector<Member> entries;
    for (std::size_t k = 0; k < value_.size(); ++k) {
      entries.emplace_back(value_[k], path_, fmt::format("{}[{}]", place_, k));
    }
    return entries;
  }
  std::size_t count() const {
    constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
    if (!value_.is_number_unsigned() || value_.get<std::uint64_t>() >= kMost) {
      fail("must be an integer in [0, 2^31)");
    }
    return value_.get<std::size_t>();
  }
  void texts() const {
    for (const auto& entry : list()) entry.text();
  }
  // A null stands for an infinite number.
  std::size_t numbers(bool may_be_null = false) const {
    const auto entries = list();
    for (const auto& entry : entries) {
      const bool null = may_be_null && entry.value_.is_null();
      if (!null && !entry.value_.is_number()) entry.fail("must be a number");
    }
    return entries.size();
  }

  // The numbers of a packed array.
  template <class Number>
  std::vector<Number> packed(const char* type) const {
    const bool one = object().size() == 1 && value_.contains(type) && value_[type].is_string();
    if (!one) fail(fmt::format("must be {{\"{}\": \"...\"}} alone", type));
    const auto bytes = from_base64(value_[type].get_ref<const std::string&>());
    if (!bytes || bytes->size() % sizeof(Number) != 0) {
      fail(fmt::format("holds no base64 of whole {} values", type));
    }
    std::vector<Number> numbers(bytes->size() / sizeof(Number));
    if (!numbers.empty()) std::memcpy(numbers.data(), bytes->data(), bytes->size());
    return numbers;
  }
  void floats(std::size_t wanted) const { require_size(packed<float>("f32").size(), wanted); }

  // Positions among `below` things; as many as `wanted` where that is known.
  template <class Number>
  std::vector<Number> places(const char* type, std::size_t below,
                             std::optional<std::size_t> wanted = {}) const {
    auto found = packed<Number>(type);
    if (wanted) require_size(found.size(), *wanted);
    for (const Number place : found) {
      if (std::cmp_less(place, 0) || std::cmp_greater_equal(place, below)) {
        fail(fmt::format("points to {}, outside [0, {})", place, below));
      }
    }
    return found;
  }

  void require_size(std::size_t size, std::size_t wanted) const {
    if (size != wanted) fail(fmt::format("has {} entries in place of {}", size, wanted));
  }

 private:
  const Json& value_;
  const std::string& path_;
  std::string place_;
};

void check_columns(const Member& columns, std::size_t count) {
  for (const auto& column : columns.list()) {
    for (const char* key : {"key", "label", "unit", "help"}) column[key].text();
    if (!column["charted"].value().is_boolean()) column["charted"].fail("must be true or false");
    column["values"].floats(count);
  }
}

void check_words(const Member& document) {
  for (const char* key : {"version", "title", "unit", "truth_note"}) document[key].text();
  const auto kinds = enum_names(ReportKind{});
  const auto is_it = [kind = document["kind"].text()](const auto& known) {
    return known.name == kind;
  };
  if (std::none_of(kinds.begin(), kinds.end(), is_it)) {
    document["kind"].fail("must be one of " + joined_enum_names<ReportKind>());
  }
  for (const char* key : {"node", "nodes", "edge", "edges", "trusted"}) {
    document["nouns"][key].text();
  }
  for (const auto& paragraph : document["summary"].list()) {
    paragraph["heading"].text();
    paragraph["text"].text();
  }
  document["warnings"].texts();
  document["notes"].texts();
  document["options"].object();
}

std::size_t check_nodes(const Member& document) {
  const Member nodes = document["nodes"];
  const std::size_t count = nodes["count"].count();
  const Member names = nodes["names"];
  if (names.value().is_array()) {
    names.texts();
    names.require_size(names.value().size(), count);
  } else {
    names.require_size(names.packed<std::uint64_t>("u64").size(), count);
  }
  nodes["landmarks"].places<std::int32_t>("i32", count);
  check_columns(nodes["columns"], count);
  if (nodes.has("path")) nodes["path"].floats(count);
  if (nodes.has("robots")) {
    const Member robots = nodes["robots"];
    robots["names"].texts();
    robots["of"].places<std::int32_t>("i32", robots["names"].value().size(), count);
  }
  return count;
}

void check_layouts(const Member& document, std::size_t nodes) {
  const std::size_t dimension = document["dimension"].count();
  if (dimension < 1 || dimension > 3) document["dimension"].fail("must be 1, 2 or 3");
  const auto layouts = document["layouts"].list();
  if (layouts.empty()) document["layouts"].fail("must not be empty");
  for (const auto& layout : layouts) {
    layout["key"].text();
    layout["label"].text();
    layout["origin"].numbers();
    layout["positions"].floats(nodes * dimension);
    if (layout.has("truth")) layout["truth"].floats(nodes * dimension);
    if (layout.has("errors")) layout["errors"].floats(nodes);
  }
}

void check_conflicts(const Member& conflicts, std::size_t candidates) {
  const auto named = conflicts["candidates"].places<std::uint32_t>("u32", candidates);
  const Member offsets = conflicts["offsets"];
  const auto places = offsets.places<std::uint32_t>("u32", named.size() + 1, candidates + 1);
  if (!std::is_sorted(places.begin(), places.end()) || places.front() != 0 ||
      places.back() != named.size()) {
    offsets.fail("must ascend from 0 to the number of candidates named");
  }
}

std::size_t check_candidates(const Member& document, std::size_t nodes) {
  constexpr std::size_t kAny = std::size_t{1} << 32;
  constexpr std::size_t kVerdicts = 3;
  const Member all = document["candidates"];
  const std::size_t count = all["count"].count();
  all["stages"].texts();
  all["edge"].places<std::uint32_t>("u32", kAny, count);
  all["line"].places<std::uint32_t>("u32", kAny, count);
  all["from"].places<std::int32_t>("i32", nodes, count);
  all["to"].places<std::int32_t>("i32", nodes, count);
  all["verdict"].places<std::uint8_t>("u8", kVerdicts, count);
  all["stage"].places<std::uint32_t>("u32", all["stages"].value().size(), count);
  all["score"].floats(count);
  all["threshold"].floats(count);
  check_columns(all["columns"], count);
  if (all.has("conflicts")) check_conflicts(all["conflicts"], count);
  return count;
}

void check_spectra(const Member& document, std::size_t candidates) {
  const Member heat = document["heat"];
  const std::size_t scales = heat["scales"].numbers();
  const auto judged = heat["candidates"].places<std::uint32_t>("u32", candidates);
  heat["distances"].floats(judged.size() * scales);
  const std::size_t thresholds = heat["thresholds"].numbers(true);
  if (thresholds > 0) heat["thresholds"].require_size(thresholds, scales);
  heat["note"].text();
  const Member spectrum = document["spectrum"];
  spectrum["values"].numbers();
  spectrum["null_count"].count();
  spectrum["scales"].numbers();
  spectrum["note"].text();
}

void check_rounds(const Member& document) {
  const Member rounds = document["rounds"];
  rounds["columns"].texts();
  for (const auto& row : rounds["rows"].list()) {
    row.texts();
    row.require_size(row.value().size(), rounds["columns"].value().size());
  }
}

}  // namespace

void check_report(const Json& document, const std::string& path) {
  if (!document.is_object() || document.value("schema", Json()) != kReportSchema) {
    throw ParseError({path, 0, 0}, "",
                     std::string("is not an ") + kReportSchema +
                         " document; 'prune --report FILE.json' writes one");
  }
  const Member whole(document, path, "");
  check_words(whole);
  const std::size_t nodes = check_nodes(whole);
  check_layouts(whole, nodes);
  if (whole["trusted"].places<std::int32_t>("i32", nodes).size() % 2 != 0) {
    whole["trusted"].fail("must hold pairs");
  }
  const std::size_t candidates = check_candidates(whole, nodes);
  check_spectra(whole, candidates);
  check_rounds(whole);
}

void check_same_graph(const Json& first, const Json& second, const std::string& path) {
  using Place = Json::json_pointer;
  // Kind and dimension come first: nodes of another kind differ anyhow.
  for (const char* place : {"/kind", "/dimension", "/nodes/names", "/candidates/edge",
                            "/candidates/from", "/candidates/to"}) {
    if (first[Place(place)] == second[Place(place)]) continue;
    throw ParseError({path, 0, 0}, "",
                     fmt::format("is not about the same graph as the first report: {} differs",
                                 std::string_view(place).substr(1)));
  }
}

}  // namespace isotherm::apps
