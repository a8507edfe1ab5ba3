#include "edges/space/place_chain.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "spectral/edges/space/points.hpp"
#include "spectral/edges/space/triple.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

template <int Dimension>
void expect_means_of_triple() {
  Triple triple;
  triple.dimension = Dimension;
  const auto path = path_graph(3);
  const ContactGraph graph(path, equal_worth(path));
  const ContactModel model{triple.width, triple.astray, triple.spread};
  PlaceChain<Dimension> chain(graph, model, Places<Dimension>::Zero(Dimension, 3), 1);
  for (int k = 0; k < 1000; ++k) chain.move_and_fit();
  constexpr int kMoves = 100'000;
  const auto distance = [&chain](Index from, Index to) {
    return (chain.places().col(from) - chain.places().col(to)).norm();
  };
  double edge = 0.0, open = 0.0, near = 0.0, stretched = 0.0;
  int taken = 0;
  for (int k = 0; k < kMoves; ++k) {
    taken += chain.move() ? 1 : 0;
    edge += distance(0, 1);
    open += distance(0, 2);
    near += triple.rho(distance(0, 2));
    stretched += distance(1, 2) > 1.0 ? 1.0 : 0.0;
  }
  EXPECT_NEAR(taken / 1e5, 0.63, 0.15);
  // About four deviations of the chain's means.
  EXPECT_NEAR(edge / kMoves, triple.mean([](const auto& apart) { return apart.first; }), 0.02);
  EXPECT_NEAR(open / kMoves, triple.mean([](const auto& apart) { return apart.open; }), 0.02);
  EXPECT_NEAR(near / kMoves, triple.mean([&](const auto& apart) { return triple.rho(apart.open); }),
              0.01);
  EXPECT_NEAR(stretched / kMoves,
              triple.mean([](const auto& apart) { return apart.second > 1.0 ? 1.0 : 0.0; }), 0.02);
}

TEST(PlaceChain, MeansAreThoseOfAnIntegralInThePlane) { expect_means_of_triple<2>(); }

TEST(PlaceChain, MeansAreThoseOfAnIntegralInSpace) { expect_means_of_triple<3>(); }

struct Moving {
  Random random{17};
  Places<3> places = 2.0 * points_in_ball(30, 3, random);
  WeightedGraph graph = contacts(places, 1.0, 5, random);
  ContactGraph contact_graph{graph, equal_worth(graph)};
  ContactModel model{1.0, 1e-2, 2.0};  // all pairs are heard
  std::vector<VertexPair> open = contact_graph.open_pairs(places, 100.0);
  Motion<3> start{places, Places<3>(3, 30), {}, 0.0};

  Moving() {
    for (double& p : start.momenta.reshaped()) p = random.normal();
    start.energy = contact_graph.energy(places, model, open, start.gradient);
  }

  Motion<3> after(double step, int count, Motion<3> motion) const {
    leap(contact_graph, model, open, step, count, motion);
    return motion;
  }
};

TEST(Leap, GoesBackWhereItCameFrom) {
  const Moving moving;
  auto end = moving.after(0.02, 50, moving.start);
  EXPECT_GT((end.places - moving.places).norm(), 1.0);
  end.momenta *= -1.0;
  const auto back = moving.after(0.02, 50, end);
  EXPECT_LT((back.places - moving.places).norm(), 1e-10);
  EXPECT_LT((back.momenta + moving.start.momenta).norm(), 1e-10);
}

TEST(Leap, LosesEnergyByTheSquareOfTheStep) {
  const Moving moving;
  const auto lost = [&](double step) {
    const auto end = moving.after(step, static_cast<int>(std::lround(0.2 / step)), moving.start);
    return std::abs(end.total() - moving.start.total());
  };
  const double coarse = lost(0.02), fine = lost(0.01), finer = lost(0.005);
  EXPECT_GT(coarse, 1e-6);
  EXPECT_NEAR(coarse / fine, 4.0, 0.4);
  EXPECT_NEAR(fine / finer, 4.0, 0.2);
}

}  // namespace
}  // namespace isotherm::spectral::detail
