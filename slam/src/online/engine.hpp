#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "isotherm/slam/online/online_consensus.hpp"
#include "online/edge_log.hpp"
#include "online/open_runs.hpp"
#include "online/outlook.hpp"
#include "online/paced_task.hpp"
#include "online/reason.hpp"
#include "online/saved_edges.hpp"
#include "online/snapshot.hpp"

namespace isotherm::slam::detail {

/// Judges each loop when it comes, by the latest snapshot that is explained, and meanwhile explains
/// the next ones: from where the last one stood and, where loops have grown, from every start, as
/// often as effort allows.
template <class Pose>
class OnlineEngine {
 public:
  using Matrix = typename Pose::Matrix;

  OnlineEngine(const OnlineOptions& options, RunContext run);

  std::vector<LoopChange> add(VertexId from, VertexId to, const Pose& T_from_to,
                              const Matrix& information, LinkKind link);
  detail::EdgeLog<Pose>& log() noexcept { return log_; }
  const detail::EdgeLog<Pose>& log() const noexcept { return log_; }

  /// Adds an edge and leaves it at that until catch_up().
  void add_silently(VertexId from, VertexId to, const Pose& T_from_to, const Matrix& information,
                    LinkKind link);

  /// What journal() has written.
  detail::Written& written() noexcept { return written_; }

  std::vector<LoopChange> catch_up();
  PruneResult result() const;
  std::vector<LoopChange> finish();
  spectral::EdgeVerdicts verdicts() const;
  PoseGraph<Pose> graph() const;

 private:
  /// A snapshot that is being explained.
  struct Search {
    std::shared_ptr<Snapshot<Pose>> map;
    Index loops = 0;  // that it has
    std::vector<std::shared_ptr<const Snapshot<Pose>>> from;
    std::unique_ptr<PacedTask> task;
  };

  /// The verdict on an edge, unless it is a step.
  struct Row {
    std::optional<spectral::EdgeVerdict> now;
    Grounds grounds;
    std::optional<spectral::Verdict> told;
  };

  void ask_to_go_on() const;
  void go_on();
  void search_everywhere(double budget);
  bool is_search_due() const;
  bool is_quiet() const;
  double search_work(Index loops) const;
  double allowance(Index loops) const;
  double following_credit() const;
  bool is_following_due() const;
  void follow_up(double budget);
  Search begin(bool everywhere) const;
  bool run(Search& search, double budget);
  void adopt(std::shared_ptr<Snapshot<Pose>> map);
  void take_over(const PruneResult& result);
  void judge(Index edge);
  void judge_run(Index edge);
  void consider(Index edge);
  bool may_follow(Index edge) const;
  void judge_since(Index first);
  bool has_news() const;
  bool is_accepted(Index edge) const;
  void bring_up_to_date(PoseGraph<Pose>& graph) const;
  void set(spectral::EdgeVerdict verdict, const Grounds& grounds);
  std::vector<LoopChange> changes();

  OnlineOptions options_;
  RunContext run_;
  detail::EdgeLog<Pose> log_;
  detail::Written written_;
  std::vector<Row> rows_;     // one an edge
  std::vector<Index> fresh_;  // edges whose verdict may have changed since changes()
  Index loops_ = 0;           // that have come
  Index last_loop_ = 0;       // its edge
  std::shared_ptr<const Snapshot<Pose>> map_;
  std::shared_ptr<const Snapshot<Pose>> rival_;  // of a search that led higher
  std::optional<detail::Outlook<Pose>> outlook_;
  detail::OpenRuns runs_;                // that the snapshot has not accepted
  std::map<Index, Standing> standings_;  // of these
  std::optional<Search> everywhere_;
  std::optional<Search> next_;
  Index searched_ = 0;                               // loops at the last search from every start
  typename Snapshot<Pose>::SearchWork search_work_;  // at that
  double searches_a_batch_takes_ = 1.0;
  Index search_of_ = 1;          // loops that it had
  double searches_work_ = 0.0;   // of all of those
  double following_work_ = 0.0;  // of following up
  double last_following_ = 0.0;  // of the last time
  bool finished_ = false;        // verdicts are the batch's on all that has come
};

extern template class OnlineEngine<Pose2>;
extern template class OnlineEngine<Pose3>;

}  // namespace isotherm::slam::detail
