#include "online/reason.hpp"

#include <iomanip>
#include <sstream>

namespace isotherm::slam::detail {

namespace {

std::string reason_together(double chi2) {
  std::ostringstream text;
  text << "agrees with the loops next to it, which say together how odometry has drifted (chi2 "
       << std::setprecision(3) << chi2 << " against the map so far)";
  return text.str();
}

}  // namespace

std::string reason_of(const spectral::EdgeVerdict& verdict, const Grounds& grounds) {
  if (grounds.together) return reason_together(grounds.chi2);
  if (verdict.stage == "self-edge") return "joins a pose with itself";
  if (verdict.stage == "repeat") return "repeats another edge to the last digit";
  if (verdict.stage == "waiting") return "nothing to hold it against yet";
  if (verdict.stage == "unconnected") return "nothing else joins its ends yet";
  std::ostringstream text;
  switch (verdict.verdict) {
    case spectral::Verdict::keep:
      text << "fits what odometry and the other kept loops say";
      break;
    case spectral::Verdict::prune:
      text << "contradicts odometry and the kept loops, or fits no better than chance";
      break;
    case spectral::Verdict::ambiguous:
      text << "not proven either way";
      break;
  }
  text << " (chi2 " << std::setprecision(3) << grounds.chi2 << ')';
  return text.str();
}

}  // namespace isotherm::slam::detail
