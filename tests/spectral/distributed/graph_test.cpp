#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "spectral/distributed/ranks.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

/// A file that all ranks see, for as long as this lives.
class SharedFile {
 public:
  explicit SharedFile(const std::string& text)
      : SharedFile(
            [&](const std::string& path) { std::ofstream(path, std::ios::binary) << text; }) {}
  explicit SharedFile(const std::function<void(const std::string&)>& write) {
    session().together([&] {
      if (session().rank() == 0) write(path());
    });
  }
  ~SharedFile() {
    session().together([] {});  // nobody reads it any more
    session().together([&] {
      if (session().rank() == 0) std::filesystem::remove(path());
    });
  }
  std::string path() const { return "distributed_test_input"; }
};

/// What the serial engine reads: directions merged.
GraphFile serial(const std::string& path) {
  auto file = read_graph(path);
  merge_directions(file);
  return file;
}

void expect_same(const distributed::Graph& graph, const GraphFile& file) {
  EXPECT_EQ(graph.vertex_count(), file.graph.vertex_count());
  EXPECT_EQ(graph.edge_count(), file.graph.edge_count());
  EXPECT_EQ(graph.component_count(), connected_components(file.graph).count);
  for (std::size_t k = 0; k < graph.ids().size(); ++k) {
    EXPECT_EQ(graph.ids()[k], file.ids[static_cast<std::size_t>(graph.block_begin()) + k]);
  }
  for (const auto& edge : graph.edges()) {
    const auto& other = file.graph.edge(static_cast<Index>(edge.number));
    EXPECT_EQ(edge.from, other.from);
    EXPECT_EQ(edge.to, other.to);
    EXPECT_EQ(edge.weight, other.weight);
  }
}

void expect_read_as_by_one(const std::string& text) {
  const SharedFile file(text);
  expect_same(distributed::Graph::read(session(), file.path()), serial(file.path()));
}

std::string text_of(const WeightedGraph& graph, const std::string& separator, Random& random) {
  std::string text;
  for (const auto& edge : graph.edges()) {
    text += std::to_string(7 + 3 * edge.from) + separator + std::to_string(7 + 3 * edge.to) +
            separator + std::to_string(random.uniform(0.5, 2.0)) + "\n";
  }
  return text;
}

TEST(DistributedGraph, ReadsListsAsOneMachineDoes) {
  Random random(1);
  const auto graph = loopy_path(500, 80, random);
  expect_read_as_by_one("from,to,weight\n" + text_of(graph, ",", random));
  expect_read_as_by_one("# a comment\n\n" + text_of(graph, ",", random));
  expect_read_as_by_one(text_of(graph, " ", random));
  expect_read_as_by_one("from to weight\r\n" + text_of(graph, "\t", random));
  expect_read_as_by_one("5,3");
  expect_read_as_by_one("weight,to,from\n0.5,1,2\n2,18446744073709551615,1\n");
}

TEST(DistributedGraph, MakesBothDirectionsOneEdge) {
  expect_read_as_by_one("0,1,1\n1,0,1\n1,2,3\n0,1,1\n2,1,5\n3,3,2\n1,0,4\n2,0,1\n0,1,9\n");
  Random random(2);
  std::string text;
  for (int k = 0; k < 2000; ++k) {
    text += std::to_string(random.index(20)) + "," + std::to_string(random.index(20)) + "," +
            std::to_string(random.uniform(0.5, 2.0)) + "\n";
  }
  expect_read_as_by_one(text);
}

TEST(DistributedGraph, ReadsMatrices) {
  expect_read_as_by_one(
      "%%MatrixMarket matrix coordinate real symmetric\n% a comment\n6 6 5\n"
      "2 1 0.5\n3 2 2\n4 4 7\n5 3 0\n5 4 1e-3\n");
  expect_read_as_by_one("%%MatrixMarket matrix coordinate pattern symmetric\n3 3 2\n2 1\n3 1\n");
}

TEST(DistributedGraph, ReadsStructuresOfPoseGraphs) {
  const std::string rest = " 1 0 0 1 0 0 1 0 1\n";
  const SharedFile file(
      "VERTEX_SE2 5 0 0 0\nVERTEX_SE2 9 1 0 0\n# said\nVERTEX_SE2 70 1 0 0\n"
      "EDGE_SE2 5 9" +
      rest + "EDGE_PRIOR 5 1\nEDGE_SE2 9 11" + rest);
  const auto graph = distributed::Graph::read(session(), file.path());
  EXPECT_EQ(graph.vertex_count(), 4);
  EXPECT_EQ(graph.edge_count(), 2);
  EXPECT_EQ(graph.component_count(), 2);
}

TEST(DistributedGraph, ReadsTheBinaryForm) {
  Random random(3);
  const auto graph = disjoint_union(loopy_path(300, 40, random), WeightedGraph(3, {}));
  std::vector<std::uint64_t> ids;
  for (Index v = 0; v < graph.vertex_count(); ++v) ids.push_back(100 + 2 * v);
  const SharedFile file([&](const std::string& path) { write_binary_graph(path, graph, ids); });
  const auto mine = distributed::Graph::read(session(), file.path());
  expect_same(mine, serial(file.path()));
  const auto found = mine.positions_of(std::vector<std::uint64_t>{100, 104, 700});
  EXPECT_EQ(found, (std::vector<Index>{0, 2, 300}));
  EXPECT_EQ(mine.ids_of(found), (std::vector<std::uint64_t>{100, 104, 700}));
  EXPECT_THROW(mine.positions_of(std::vector<std::uint64_t>{100, 101}), InvalidArgument);
}

/// All ranks have to say the same, as one machine does.
void expect_same_complaint(const std::string& text) {
  const SharedFile file(text);
  std::string expected, said;
  try {
    read_graph(file.path());
  } catch (const Error& error) {
    expected = error.what();
  }
  try {
    distributed::Graph::read(session(), file.path());
  } catch (const ParseError& error) {
    said = error.what();
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(said, expected);
}

TEST(DistributedGraph, SaysOnEveryRankWhichLineIsAtFault) {
  Random random(4);
  const auto lines = text_of(loopy_path(300, 30, random), ",", random);
  for (const std::size_t place : {lines.size() / 8, lines.size() / 2, lines.size() - 10}) {
    const auto line = lines.find('\n', place) == lines.npos ? 0 : lines.find('\n', place) + 1;
    for (const char* fault : {"x,2,1\n", "1,2,-1\n", "1\n", "1,2,nan\n"}) {
      expect_same_complaint(std::string(lines).insert(line, fault));
      expect_same_complaint("from,to,weight\n" + std::string(lines).insert(line, fault));
    }
  }
  expect_same_complaint("");
  expect_same_complaint("# nothing\n");
  expect_same_complaint("x,y\n1,2\n");
  expect_same_complaint("%%MatrixMarket matrix coordinate real symmetric\n3 3 4\n2 1 1\n3 1 1\n");
  expect_same_complaint("%%MatrixMarket matrix coordinate real symmetric\n3 3 2\n2 1 1\n4 1 1\n");
}

TEST(DistributedGraph, RefusesWhatCannotBeReadInParts) {
  EXPECT_THROW(distributed::Graph::read(session(), "no such file"), FileError);
  EXPECT_THROW(distributed::Graph::read(session(), "-"), InvalidArgument);
  EXPECT_THROW(distributed::Graph::read(session(), "."), FileError);
  const SharedFile compressed(std::string("\x1f\x8b\x08\x00", 4));
  EXPECT_THROW(distributed::Graph::read(session(), compressed.path()), FileError);
}

TEST(DistributedGraph, RefusesBrokenBinaryForms) {
  Random random(5);
  const auto graph = loopy_path(50, 10, random);
  std::vector<std::uint64_t> ids;
  for (Index v = 0; v < graph.vertex_count(); ++v) ids.push_back(static_cast<std::uint64_t>(v));
  const auto expect_refusal = [&](const std::function<void(std::fstream&)>& damage) {
    const SharedFile file([&](const std::string& path) {
      write_binary_graph(path, graph, ids);
      std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
      damage(stream);
    });
    EXPECT_THROW(distributed::Graph::read(session(), file.path()), ParseError);
    EXPECT_THROW(read_graph(file.path()), ParseError);
  };
  expect_refusal([](std::fstream& file) { file.seekp(8).put(2); });                      // version
  expect_refusal([](std::fstream& file) { file.seekp(24).put(1); });                     // edges
  expect_refusal([](std::fstream& file) { file.seekp(32 + 30 * 8).put(1); });            // a number
  expect_refusal([](std::fstream& file) { file.seekp(32 + 50 * 8 + 2).put(1); });        // an end
  expect_refusal([](std::fstream& file) { file.seekp(32 + 50 * 8 + 15).put('\xff'); });  // a weight
  expect_refusal([](std::fstream& file) { file.seekp(0, std::ios::end).put(0); });
}

TEST(DistributedGraph, MayBeSmallerThanTheNumberOfRanks) {
  expect_read_as_by_one("3,4\n");
  const auto nothing = distributed::Graph::from_edges(session(), 0, {});
  EXPECT_EQ(nothing.vertex_count(), 0);
  EXPECT_EQ(nothing.component_count(), 0);
  const auto one = distributed::Graph::from_edges(session(), 1, {});
  EXPECT_EQ(one.component_count(), 1);
}

TEST(DistributedGraph, ComponentsOfPartitionedGraphs) {
  Random random(6);
  const auto mesh = grid_graph(70, 70);
  const auto both = disjoint_union(disjoint_union(mesh, loopy_path(3000, 30, random)), mesh);
  const auto graph = distribute(relabel(both, random_permutation(both.vertex_count(), random)));
  EXPECT_EQ(graph.component_count(), 3);
  EXPECT_LT(graph.cut(), 0.1);
}

}  // namespace
}  // namespace isotherm::spectral
