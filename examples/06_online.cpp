// Judges loop closures while a robot drives: a city in order of time, with false loops among its
// own, an edge at a time as a front end would hand them over.
#include <cstdio>

#include <isotherm/slam.hpp>

int main() {
  using namespace isotherm::slam;

  const auto city = simulate_city({.poses = 400, .measurements = {.loops = 150}, .seed = 7});
  const auto corrupted = corrupt(city.graph, city.truth, {.count = 75, .seed = 7});
  const auto stream = in_replay_order(corrupted.graph);

  OnlineConsensus<Pose2> online;
  int changed = 0;  // verdicts that did not stay what they were at first
  for (const auto& edge : stream.constraints) {
    const auto changes = online.add_edge(stream.ids[edge.from], stream.ids[edge.to], edge.T_from_to,
                                         edge.information);
    for (const auto& change : changes) changed += change.first ? 0 : 1;
  }
  const auto on_the_way = online.verdicts();
  online.finish();
  const auto batch = prune(online.input()).verdicts;

  int differ = 0;
  for (std::size_t k = 0; k < batch.size(); ++k) {
    differ += online.verdicts()[k].verdict == batch[k].verdict ? 0 : 1;
  }
  std::printf("%zu loops, %d verdicts changed on the way, %d differ from the batch in the end\n",
              on_the_way.size(), changed, differ);
  return differ == 0 ? 0 : 1;
}
