#include "verbs/follow/event_lines.hpp"

#include <cmath>
#include <iostream>

#include "isotherm/base/error.hpp"
#include "option_flags.hpp"

namespace isotherm::apps {

using spectral::Verdict;

EventLines::EventLines(const std::string& path) : path_(path) {
  if (path.empty()) return;
  out_ = &std::cout;
  if (path == "-") {
    path_ = "<stdout>";
    return;
  }
  file_.open(path);
  out_ = &file_;
  if (!file_) throw FileError(path, "cannot be written");
}

void EventLines::write(const std::string& line) {
  if (out_ == nullptr) return;
  *out_ << line << '\n' << std::flush;
  if (!*out_) throw FileError(path_, "cannot be written");
}

void EventLines::tell(const slam::LoopChange& change, Time time) {
  const auto& verdict = change.verdict;
  const double probability = verdict.probability;
  const Json line = {{"event", change.first ? "verdict" : "change"},
                     {"at", time.at},
                     {"poses", time.poses},
                     {"edge", verdict.edge},
                     {"from", verdict.from},
                     {"to", verdict.to},
                     {"verdict", std::string(enum_name(verdict.verdict))},
                     {"probability", std::isfinite(probability) ? Json(probability) : Json()},
                     {"stage", verdict.stage},
                     {"reason", change.reason}};
  write(line.dump());
}

void EventLines::error(double ate, Time time) {
  const Json line = {{"event", "error"}, {"at", time.at}, {"poses", time.poses}, {"ate", ate}};
  write(line.dump());
}

void EventLines::end(const spectral::EdgeVerdicts& verdicts, Time time) {
  const Json line = {{"event", "end"},
                     {"edges", time.at},
                     {"poses", time.poses},
                     {"loops", verdicts.size()},
                     {"kept", count(verdicts, Verdict::keep)},
                     {"pruned", count(verdicts, Verdict::prune)},
                     {"ambiguous", count(verdicts, Verdict::ambiguous)}};
  write(line.dump());
}

}  // namespace isotherm::apps
