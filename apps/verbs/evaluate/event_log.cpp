#include "verbs/evaluate/event_log.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "isotherm/base/json_reader.hpp"
#include "isotherm/base/text_reader.hpp"

namespace isotherm::apps {
namespace {

// One line, whatever its members.
struct Event {
  std::string kind;
  std::string verdict;
  std::optional<std::int64_t> at;
  std::optional<std::int64_t> poses;
  std::optional<std::int64_t> edge;
  std::optional<std::int64_t> edges;
  std::optional<double> ate;
  std::optional<double> probability;
};

std::int64_t read_count(JsonReader& json) {
  const auto count = json.unsigned_integer("a count");
  if (count > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max())) {
    json.fail("expected a count below 2^31");
  }
  return static_cast<std::int64_t>(count);
}

Event read_event(JsonReader& json) {
  Event event;
  const std::array<std::pair<const char*, std::optional<std::int64_t>*>, 4> counts = {
      {{"at", &event.at}, {"poses", &event.poses}, {"edge", &event.edge}, {"edges", &event.edges}}};
  json.object("an event, as 'follow' writes it", [&](const std::string& name) {
    const auto known = std::ranges::find(counts, name, [](const auto& c) { return c.first; });
    if (name == "event") {
      event.kind = json.string("the kind of an event");
    } else if (name == "verdict") {
      event.verdict = json.string("a verdict");
    } else if (name == "ate") {
      event.ate = json.number("an error");
    } else if (name == "probability" && !json.at_null()) {
      event.probability = json.number("a probability");
    } else if (known != counts.end()) {
      *known->second = read_count(json);
    } else {
      json.skip();
    }
  });
  return event;
}

spectral::Verdict verdict_of(const std::string& name, const JsonReader& json) {
  for (const auto& [verdict, known] : enum_names(spectral::Verdict())) {
    if (known == name) return verdict;
  }
  json.fail("expected a verdict");
}

void take(const Event& event, const JsonReader& json, EventLog& log) {
  const auto have = [&json](const auto& value, const char* name) {
    if (!value) json.fail(std::string("an event without '") + name + "'");
    return *value;
  };
  if (event.kind == "verdict" || event.kind == "change") {
    log.verdicts.push_back({have(event.edge, "edge"), verdict_of(event.verdict, json),
                            have(event.at, "at"), have(event.poses, "poses"), event.probability});
    log.edges = std::max(log.edges, log.verdicts.back().at);
  } else if (event.kind == "error") {
    log.errors.push_back(
        {have(event.at, "at"), have(event.poses, "poses"), have(event.ate, "ate")});
  } else if (event.kind == "end") {
    log.edges = have(event.edges, "edges");
  } else {
    json.fail("expected an event of kind verdict, change, error or end");
  }
}

}  // namespace

EventLog read_event_log(const std::string& path) {
  const std::string text = read_whole(path);
  JsonReader json(path == "-" ? "<stdin>" : path, text);
  EventLog log;
  while (!json.at_end()) take(read_event(json), json, log);
  return log;
}

}  // namespace isotherm::apps
