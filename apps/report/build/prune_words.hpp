#pragma once

#include <string>

#include "isotherm/slam/prune/prune.hpp"
#include "report/report.hpp"

/// What a report of `prune` says in words and in its table of rounds.
namespace isotherm::apps {

/// The moves of consensus or the scales of heat; empty for other methods.
ReportRounds report_rounds(const slam::PruneResult& decisions);

std::string words_of_decisions(const slam::PruneResult& decisions, const ReportNouns& nouns,
                               bool keep_ambiguous);

std::string words_of_certainty(const slam::PruneResult& decisions,
                               const slam::PruneOptions& options, const ReportNouns& nouns);

}  // namespace isotherm::apps
