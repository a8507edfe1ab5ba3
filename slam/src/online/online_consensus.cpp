#include "isotherm/slam/online/online_consensus.hpp"

#include <utility>

#include "isotherm/base/error.hpp"
#include "online/engine.hpp"
#include "online/saved_edges.hpp"

namespace isotherm::slam {

void OnlineOptions::validate() const {
  consensus.validate();
  require_fields_in_range(*this);
}

template <class Pose>
OnlineConsensus<Pose>::OnlineConsensus(const OnlineOptions& options, RunContext run) {
  options.validate();
  engine_ = std::make_unique<detail::OnlineEngine<Pose>>(options, std::move(run));
}

template <class Pose>
OnlineConsensus<Pose>::~OnlineConsensus() = default;
template <class Pose>
OnlineConsensus<Pose>::OnlineConsensus(OnlineConsensus&&) noexcept = default;
template <class Pose>
OnlineConsensus<Pose>& OnlineConsensus<Pose>::operator=(OnlineConsensus&&) noexcept = default;

template <class Pose>
std::vector<LoopChange> OnlineConsensus<Pose>::add_odometry(VertexId from, VertexId to,
                                                            const Pose& T_from_to,
                                                            const Matrix& information) {
  return engine_->add(from, to, T_from_to, information, LinkKind::odometry);
}

template <class Pose>
std::vector<LoopChange> OnlineConsensus<Pose>::add_loop(VertexId from, VertexId to,
                                                        const Pose& T_from_to,
                                                        const Matrix& information) {
  return engine_->add(from, to, T_from_to, information, LinkKind::loop);
}

template <class Pose>
std::vector<LoopChange> OnlineConsensus<Pose>::add_edge(VertexId from, VertexId to,
                                                        const Pose& T_from_to,
                                                        const Matrix& information, LinkKind link) {
  return engine_->add(from, to, T_from_to, information, link);
}

template <class Pose>
void OnlineConsensus<Pose>::set_pose(VertexId id, const Pose& T_world_vertex) {
  engine_->log().set_pose(id, T_world_vertex);
}

template <class Pose>
void OnlineConsensus<Pose>::fix(VertexId id) {
  engine_->log().fix(id);
}

template <class Pose>
spectral::EdgeVerdicts OnlineConsensus<Pose>::verdicts() const {
  return engine_->verdicts();
}

template <class Pose>
PoseGraph<Pose> OnlineConsensus<Pose>::graph() const {
  return engine_->graph();
}

template <class Pose>
PoseGraph<Pose> OnlineConsensus<Pose>::input() const {
  return engine_->log().graph();
}

template <class Pose>
PruneResult OnlineConsensus<Pose>::result() const {
  return engine_->result();
}

template <class Pose>
std::vector<LoopChange> OnlineConsensus<Pose>::finish() {
  return engine_->finish();
}

template <class Pose>
std::vector<LoopChange> OnlineConsensus<Pose>::catch_up() {
  return engine_->catch_up();
}

template <class Pose>
void OnlineConsensus<Pose>::save(std::ostream& out) const {
  detail::Written nothing;
  detail::write_edges(out, engine_->log(), nothing);
}

template <class Pose>
void OnlineConsensus<Pose>::journal(std::ostream& out) {
  detail::write_edges(out, engine_->log(), engine_->written());
}

template <class Pose>
OnlineConsensus<Pose> OnlineConsensus<Pose>::load(std::istream& in, const OnlineOptions& options,
                                                  RunContext run) {
  OnlineConsensus<Pose> online(options, std::move(run));
  auto& engine = *online.engine_;
  detail::read_edges<Pose>(in,
                           {[&](VertexId id, const Pose& pose) { engine.log().set_pose(id, pose); },
                            [&](VertexId id) { engine.log().fix(id); },
                            [&](const auto& edge) {
                              engine.add_silently(edge.from, edge.to, edge.measured.T_from_to,
                                                  edge.measured.information, edge.measured.link);
                            }});
  engine.catch_up();
  engine.written() = {engine.log().posed().size(), engine.log().fixed().size(),
                      engine.log().edges().size(), true};
  return online;
}

template class OnlineConsensus<Pose2>;
template class OnlineConsensus<Pose3>;

}  // namespace isotherm::slam
