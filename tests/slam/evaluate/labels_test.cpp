#include "isotherm/slam/evaluate/labels.hpp"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {
namespace {

PoseGraph<Pose2> line_with_loop(const Pose2& measured) {
  PoseGraph<Pose2> graph;
  graph.ids = {100, 101, 102};
  for (Index v = 0; v < 2; ++v) graph.constraints.push_back({v, v + 1, Pose2(1, 0, 0)});
  graph.constraints.push_back({2, 0, measured});
  return graph;
}

std::vector<std::optional<Pose2>> line_truth() {
  return {Pose2(0, 0, 0), Pose2(1, 0, 0), Pose2(2, 0, 0)};
}

Label label_of(const Pose2& measured, const std::vector<std::optional<Pose2>>& truth,
               const LabelOptions& options = {}) {
  const auto graph = line_with_loop(measured);
  const auto labels = label_candidates(graph, edge_roles(graph), truth, options);
  EXPECT_EQ(labels.size(), 1u);
  EXPECT_EQ(labels[0].edge, 2);
  EXPECT_EQ(labels[0].from, 102u);
  EXPECT_EQ(labels[0].to, 100u);
  return labels[0].label;
}

TEST(LabelCandidates, ComparesRelativePoses) {
  EXPECT_EQ(label_of(Pose2(-2.0, 1.99, 0.0), line_truth()), Label::correct);
  EXPECT_EQ(label_of(Pose2(-2.0, 2.01, 0.0), line_truth()), Label::incorrect);
  EXPECT_EQ(label_of(Pose2(-2.0, 0.0, 0.49), line_truth()), Label::correct);
  EXPECT_EQ(label_of(Pose2(-2.0, 0.0, -0.51), line_truth()), Label::incorrect);
  EXPECT_EQ(label_of(Pose2(-2.0, 0.0, 6.28), line_truth()), Label::correct) << "a full turn";
}

TEST(LabelCandidates, NoTruthNoLabel) {
  auto truth = line_truth();
  truth[2].reset();
  EXPECT_EQ(label_of(Pose2(50.0, 0.0, 0.0), truth), Label::ignore);
}

TEST(LabelCandidates, WhatIsTooCloseToCallIsIgnored) {
  const LabelOptions options = {.ignore_band = 1.0};
  EXPECT_EQ(label_of(Pose2(-2.0, 0.99, 0.0), line_truth(), options), Label::correct);
  EXPECT_EQ(label_of(Pose2(-2.0, 1.01, 0.0), line_truth(), options), Label::ignore);
  EXPECT_EQ(label_of(Pose2(-2.0, 2.99, 0.0), line_truth(), options), Label::ignore);
  EXPECT_EQ(label_of(Pose2(-2.0, 3.01, 0.0), line_truth(), options), Label::incorrect);
  EXPECT_EQ(label_of(Pose2(-2.0, 2.0, 0.51), line_truth(), options), Label::incorrect);
}

TEST(LabelCandidates, RejectsBadArguments) {
  const auto graph = line_with_loop(Pose2());
  EXPECT_THROW(label_candidates(graph, edge_roles(graph), {Pose2()}), InvalidArgument);
  EXPECT_THROW(
      label_candidates(graph, edge_roles(graph), line_truth(), {.max_translation_error = 0.0}),
      InvalidArgument);
  EXPECT_THROW(label_candidates(graph, edge_roles(graph), line_truth(), {.ignore_band = -1.0}),
               InvalidArgument);
}

}  // namespace
}  // namespace isotherm::slam
