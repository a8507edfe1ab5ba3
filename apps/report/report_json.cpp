#include "report/report_json.hpp"

#include <bit>
#include <cmath>
#include <span>

#include "report/base64.hpp"

namespace isotherm::apps {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie");

constexpr const char* type_name(float) { return "f32"; }
constexpr const char* type_name(std::int32_t) { return "i32"; }
constexpr const char* type_name(std::uint32_t) { return "u32"; }
constexpr const char* type_name(std::uint8_t) { return "u8"; }
constexpr const char* type_name(std::uint64_t) { return "u64"; }

template <class Number>
Json packed(const std::vector<Number>& values) {
  return {{type_name(Number{}), base64(std::as_bytes(std::span(values)))}};
}

// JSON has no infinity; null stands for it.
Json plain(const std::vector<double>& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(std::isfinite(value) ? Json(value) : Json());
  return json;
}

Json to_json(const ReportColumn& column) {
  return {{"key", column.key},   {"label", column.label},     {"unit", column.unit},
          {"help", column.help}, {"charted", column.charted}, {"values", packed(column.values)}};
}

Json to_json(const ReportLayout& layout) {
  Json json = {{"key", layout.key},
               {"label", layout.label},
               {"origin", layout.origin},
               {"positions", packed(layout.positions)}};
  if (!layout.truth.empty()) json["truth"] = packed(layout.truth);
  if (!layout.errors.empty()) json["errors"] = packed(layout.errors);
  return json;
}

Json to_json(const ReportCandidates& all) {
  Json json = {{"count", all.size()},        {"edge", packed(all.edge)},
               {"from", packed(all.from)},   {"to", packed(all.to)},
               {"line", packed(all.line)},   {"verdict", packed(all.verdict)},
               {"score", packed(all.score)}, {"threshold", packed(all.threshold)},
               {"stage", packed(all.stage)}, {"stages", all.stages},
               {"columns", Json::array()}};
  for (const auto& column : all.columns) json["columns"].push_back(to_json(column));
  if (!all.conflict_offsets.empty()) {
    json["conflicts"] = {{"offsets", packed(all.conflict_offsets)},
                         {"candidates", packed(all.conflicts)}};
  }
  return json;
}

Json to_json(const ReportHeat& heat) {
  return {{"scales", heat.scales},
          {"candidates", packed(heat.candidates)},
          {"distances", packed(heat.distances)},
          {"thresholds", plain(heat.thresholds)},
          {"note", heat.note}};
}

Json to_json(const ReportSpectrum& spectrum) {
  return {{"values", spectrum.values},
          {"null_count", spectrum.null_count},
          {"scales", spectrum.scales},
          {"note", spectrum.note}};
}

Json nodes_to_json(const Report& report) {
  Json json = {
      {"count", std::max(report.node_ids.size(), report.node_names.size())},
      {"names", report.node_names.empty() ? packed(report.node_ids) : Json(report.node_names)},
      {"landmarks", packed(report.landmarks)},
      {"columns", Json::array()}};
  for (const auto& column : report.node_columns) json["columns"].push_back(to_json(column));
  if (!report.robot_names.empty()) {
    json["robots"] = {{"names", report.robot_names}, {"of", packed(report.robots)}};
  }
  if (!report.path.empty()) json["path"] = packed(report.path);
  return json;
}

Json to_json(const std::vector<ReportParagraph>& summary) {
  Json json = Json::array();
  for (const auto& [heading, text] : summary) {
    json.push_back({{"heading", heading}, {"text", text}});
  }
  return json;
}

}  // namespace

Json to_json(const Report& report) {
  Json layouts = Json::array();
  for (const auto& layout : report.layouts) layouts.push_back(to_json(layout));
  return {{"schema", kReportSchema},
          {"version", ISOTHERM_VERSION},
          {"kind", enum_name(report.kind)},
          {"title", report.title},
          {"dimension", report.dimension},
          {"unit", report.unit},
          {"nouns",
           {{"node", report.nouns.node},
            {"nodes", report.nouns.nodes},
            {"edge", report.nouns.edge},
            {"edges", report.nouns.edges},
            {"trusted", report.nouns.trusted}}},
          {"summary", to_json(report.summary)},
          {"warnings", report.warnings},
          {"notes", report.notes},
          {"options", report.options},
          {"nodes", nodes_to_json(report)},
          {"trusted", packed(report.trusted)},
          {"layouts", std::move(layouts)},
          {"candidates", to_json(report.candidates)},
          {"heat", to_json(report.heat)},
          {"spectrum", to_json(report.spectrum)},
          {"rounds", {{"columns", report.rounds.columns}, {"rows", report.rounds.rows}}},
          {"truth_note", report.truth_note}};
}

}  // namespace isotherm::apps
