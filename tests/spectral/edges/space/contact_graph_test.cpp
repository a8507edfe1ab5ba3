#include "edges/space/contact_graph.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "spectral/edges/space/points.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

const ContactModel kModel{0.1, 1e-3};

/// Written down once more, over all pairs, where an edge counts as no shorter than 0.5, and a pair
/// without one as no farther than 1.5: there they count as nothing.
double energy_by_hand(const WeightedGraph& graph, const Places<3>& places) {
  const auto rho = [](double distance) {
    return 0.99 / (1.0 + std::exp((distance - 1.0) / kModel.width));
  };
  const double most = rho(0.5) + kModel.astray, least = rho(1.5);
  double energy = 0.0;
  for (Index i = 0; i < graph.vertex_count(); ++i) {
    for (Index j = i + 1; j < graph.vertex_count(); ++j) {
      const double distance = (places.col(i) - places.col(j)).norm();
      bool joined = false;
      for (const auto& edge : graph.edges()) {
        joined = joined || (edge.from == i && edge.to == j);
      }
      energy -= joined ? std::log((rho(std::max(distance, 0.5)) + kModel.astray) / most)
                       : std::log((1.0 - rho(std::min(distance, 1.5))) / (1.0 - least));
    }
  }
  return energy;
}

struct Fixture {
  Random random{11};
  Places<3> places = 2.0 * points_in_ball(40, 3, random);
  WeightedGraph graph = contacts(places, 1.0, 10, random);
  ContactGraph model{graph, equal_worth(graph)};
};

TEST(ContactGraph, EnergyIsThatOfAllPairs) {
  const Fixture fixture;
  Places<3> gradient;
  const auto all = fixture.model.open_pairs(fixture.places, 100.0);
  EXPECT_EQ(all.size() + fixture.graph.edges().size(), 40U * 39U / 2U);
  const double energy = fixture.model.energy(fixture.places, kModel, all, gradient);
  EXPECT_NEAR(energy, energy_by_hand(fixture.graph, fixture.places), 1e-3);
  const ContactModel held{kModel.width, kModel.astray, 2.0};
  EXPECT_NEAR(fixture.model.energy(fixture.places, held, all, gradient),
              energy + fixture.places.squaredNorm() / 8.0, 1e-9);
  const auto close = fixture.model.open_pairs(fixture.places, kModel.silent_from());
  EXPECT_LT(close.size(), all.size());
  EXPECT_NEAR(fixture.model.energy(fixture.places, kModel, close, gradient), energy, 1e-9);
}

TEST(ContactGraph, GradientIsThatOfTheEnergy) {
  Fixture fixture;
  constexpr double kStep = 1e-6;
  // All pairs are heard, so that none begins to be on the way.
  const ContactModel wide{1.0, 1e-3, 3.0};
  const auto pairs = fixture.model.open_pairs(fixture.places, 100.0);
  Places<3> gradient, other;
  fixture.model.energy(fixture.places, wide, pairs, gradient);
  for (const Index vertex : {0, 7, 39}) {
    for (Index c = 0; c < 3; ++c) {
      auto up = fixture.places, down = fixture.places;
      up(c, vertex) += kStep;
      down(c, vertex) -= kStep;
      const double slope = (fixture.model.energy(up, wide, pairs, other) -
                            fixture.model.energy(down, wide, pairs, other)) /
                           (2.0 * kStep);
      EXPECT_NEAR(gradient(c, vertex), slope, 1e-5 * std::max(1.0, std::abs(slope)));
    }
  }
}

TEST(ContactGraph, ChainsReachFarther) {
  const WeightedGraph graph(2, {{0, 1, 1.0}});
  const ContactGraph single(graph, std::vector{1.0}), chain(graph, std::vector{3.0});
  Places<2> places(2, 2), gradient;
  places << 0.0, 2.5, 0.0, 0.0;
  EXPECT_GT(single.energy(places, kModel, {}, gradient), 5.0);
  EXPECT_LT(chain.energy(places, kModel, {}, gradient), 0.3);
  EXPECT_TRUE(chain.open_pairs(places, 100.0).empty());
}

TEST(ContactGraph, VerticesInOnePlaceAndSelfLoopsHaveFiniteEnergy) {
  const WeightedGraph graph(3, {{0, 1, 1.0}, {2, 2, 1.0}});
  const ContactGraph contacts(graph, equal_worth(graph));
  const Places<2> places = Places<2>::Zero(2, 3);
  Places<2> gradient;
  const auto pairs = contacts.open_pairs(places, 1.0);
  EXPECT_EQ(pairs.size(), 2U);
  EXPECT_TRUE(std::isfinite(contacts.energy(places, kModel, pairs, gradient)));
  EXPECT_TRUE(gradient.allFinite());
}

}  // namespace
}  // namespace isotherm::spectral::detail
