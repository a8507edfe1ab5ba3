#include "isotherm/spectral/graph/graph_file.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm_test/parse_error.hpp"

#include "isotherm_test/temporary.hpp"

namespace isotherm::spectral {
namespace {

using isotherm_test::read_file;
using isotherm_test::TemporaryFolder;
using testing::ElementsAre;
using testing::Pair;

GraphFile parse(const std::string& text, bool strict = false) {
  TextReader reader("f", text);
  return read_graph(reader, {.strict = strict});
}

std::string error_of(const std::string& text, bool strict = false) {
  return isotherm_test::parse_error_of([&] { parse(text, strict); });
}

TEST(ReadGraph, EdgeLists) {
  for (const char* text :
       {"from,to,weight\n7,3,0.5\n3,18446744073709551615,2\n", "7,3,0.5\n3,18446744073709551615,2",
        "# comment\n7 3 0.5\r\n3\t18446744073709551615 2\n",
        "label,weight,to,from\nx,0.5,3,7\ny,2,18446744073709551615,3\n"}) {
    const auto file = parse(text);
    EXPECT_EQ(file.report.format, "edges");
    EXPECT_THAT(file.ids, ElementsAre(3, 7, 18446744073709551615u)) << text;
    ASSERT_EQ(file.graph.edge_count(), 2);
    EXPECT_EQ(file.graph.edge(0).from, 1);
    EXPECT_EQ(file.graph.edge(0).to, 0);
    EXPECT_EQ(file.graph.edge(0).weight, 0.5);
    EXPECT_EQ(file.graph.edge(1).to, 2);
  }
  EXPECT_EQ(parse("0 1\n1 2 3\n").graph.edge(0).weight, 1.0);
  EXPECT_EQ(parse("from,to\n0,1\n").graph.edge(0).weight, 1.0);
}

TEST(ReadGraph, NamesMayStandAboveBlanks) {
  EXPECT_EQ(parse("from to weight\n0 1 2\n").graph.edge(0).weight, 2.0);
  EXPECT_EQ(parse("from\tto\n0\t1\n").graph.edge_count(), 1);
  EXPECT_EQ(error_of("to from\n0 1\n"),
            "f:1:1: expected the first vertex, an integer in [0, 2^64) (got 'to')");
}

TEST(ReadGraph, PointsAndOtherSeparatorsAreTold) {
  EXPECT_EQ(error_of("id,x,y\n0,1,2\n"),
            "f: these are points, not edges; 'isotherm edges' joins points by --neighbours or "
            "--radius (got 'x')");
  EXPECT_EQ(error_of("0.5,1,2\n"),
            "f:1:1: expected the number of a vertex; these look like points, not edges; 'isotherm "
            "edges' joins points by --neighbours or --radius (got '0.5')");
  EXPECT_EQ(error_of("0;1;2\n"),
            "f:1:1: expected the first vertex, an integer in [0, 2^64); semicolons separate "
            "nothing here (got '0;1;2')");
}

TEST(ReadGraph, MatrixMarket) {
  const auto symmetric = parse(
      "%%MatrixMarket matrix coordinate real symmetric\n% comment\n4 4 3\n2 1 0.5\n3 2 2\n1 1 9\n");
  EXPECT_THAT(symmetric.ids, ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(symmetric.graph.edge_count(), 2);
  EXPECT_EQ(symmetric.graph.edge(1).weight, 2.0);
  EXPECT_THAT(symmetric.report.notes, ElementsAre(Pair("diagonal entry", 1)));

  const auto general = parse(
      "%%MatrixMarket MATRIX Coordinate Real General\n3 3 4\n2 1 0.5\n1 2 0.5000000001\n"
      "3 2 2\n2 3 2\n");
  EXPECT_EQ(general.graph.edge_count(), 2);
  EXPECT_NEAR(general.graph.edge(0).weight, 0.5, 1e-10);
  EXPECT_THAT(general.report.repairs, ElementsAre(Pair("matrix symmetrised", 1)));

  const auto pattern = parse("%%MatrixMarket matrix coordinate pattern symmetric\n2 2 1\n2 1\n");
  EXPECT_EQ(pattern.graph.edge(0).weight, 1.0);
}

TEST(ReadGraph, LocatesErrors) {
  EXPECT_EQ(error_of(""),
            "f: no edge; expected rows of from, to and weight, or a MatrixMarket matrix");
  EXPECT_EQ(error_of("0,1,-2\n"), "f:1:5: expected a weight, finite and positive (got '-2')");
  EXPECT_EQ(error_of("0 1 0\n"), "f:1:5: expected a weight, finite and positive (got '0')");
  EXPECT_EQ(error_of("0,,1\n"), "f:1:3: expected the second vertex, an integer in [0, 2^64)");
  EXPECT_EQ(error_of("a,b\n1,2\n"), "f: expected a column named 'from'");
  const std::string banner = "%%MatrixMarket matrix coordinate real ";
  EXPECT_EQ(error_of("%%MatrixMarket matrix array real general\n"),
            "f:1:23: expected 'coordinate' (got 'array')");
  EXPECT_EQ(error_of(banner + "skew-symmetric\n"),
            "f:1:39: expected symmetric or general (got 'skew-symmetric')");
  EXPECT_EQ(error_of(banner + "symmetric\n"), "f:1: expected a line of sizes");
  EXPECT_EQ(error_of(banner + "symmetric\n2 3 1\n"),
            "f:2:3: expected as many columns as rows (got '3')");
  EXPECT_EQ(error_of(banner + "symmetric\n2 2 1\n3 1 1\n"),
            "f:3:1: expected a row in [1, 2] (got '3')");
  EXPECT_EQ(error_of(banner + "symmetric\n2 2 2\n2 1 1\n"), "f: expected 2 entries, found 1");
  EXPECT_EQ(error_of(banner + "symmetric\n2 2 1\n2 1 1\n2 1 1\n"), "f:4: more entries than stated");
  EXPECT_EQ(error_of(banner + "general\n2 2 1\n2 1 1\n"), "f:3: matrix is not symmetric (got '1')");
  EXPECT_EQ(error_of(banner + "general\n2 2 2\n2 1 1\n1 2 1.1\n"),
            "f:4: matrix is not symmetric (got '1.1')");
  EXPECT_EQ(error_of(banner + "general\n2 2 2\n2 1 1\n1 2 1.0000001\n", true),
            "f:4: matrix is symmetric only up to rounding; averaged (got '1.0000001')");
}

TEST(ReadGraph, DoesNotTrustClaimedSizes) {
  const std::string banner = "%%MatrixMarket matrix coordinate real symmetric\n";
  EXPECT_EQ(error_of(banner + "2000000000 2000000000 0\n"),
            "f: claims 2000000000 rows for 0 entries");
  EXPECT_EQ(error_of(banner + "5000000000 5000000000 0\n"),
            "f:2:12: too many rows (got '5000000000')");
  EXPECT_EQ(error_of(banner + "2 2 9000000000000000000\n2 1 1\n"),
            "f: expected 9000000000000000000 entries, found 1");
}

TEST(WriteGraph, ReadsBack) {
  const TemporaryFolder folder;
  const WeightedGraph graph(4, {{0, 1, 1.0 / 3}, {3, 1, 2}, {1, 3, 4}, {2, 2, 1}, {2, 0, 7}});
  write_edge_csv(folder / "a.csv", graph, {10, 20, 30, 40});
  const auto list = read_graph(folder / "a.csv");
  EXPECT_THAT(list.ids, ElementsAre(10, 20, 30, 40));
  ASSERT_EQ(list.graph.edge_count(), 5);
  for (Index k = 0; k < 5; ++k) {
    EXPECT_EQ(list.graph.edge(k).from, graph.edge(k).from);
    EXPECT_EQ(list.graph.edge(k).weight, graph.edge(k).weight);
  }
  write_matrix_market(folder / "a.mtx", graph);
  EXPECT_EQ(read_file(folder / "a.mtx"),
            "%%MatrixMarket matrix coordinate real symmetric\n4 4 3\n"
            "2 1 0.3333333333333333\n3 1 7\n4 2 6\n");
  EXPECT_EQ(read_graph(folder / "a.mtx").graph.edge_count(), 3);
  EXPECT_THROW(write_edge_csv(folder / "b.csv", graph, {1}), InvalidArgument);
}

TEST(WriteGraph, TheBinaryFormKeepsEverything) {
  const TemporaryFolder folder;
  const WeightedGraph graph(5, {{1, 0, 1.0 / 3}, {0, 1, 7.0}, {3, 3, 1e-300}, {2, 1, 6.0}});
  const std::vector<std::uint64_t> ids = {10, 20, 30, 40, 18446744073709551615u};
  for (const char* name : {"a.isograph", "a.isograph.gz"}) {
    write_binary_graph(folder / name, graph, ids);
    const auto file = read_graph(folder / name);
    EXPECT_EQ(file.report.format, "binary");
    EXPECT_EQ(file.ids, ids);
    ASSERT_EQ(file.graph.edge_count(), 4);
    for (Index k = 0; k < 4; ++k) {
      EXPECT_EQ(file.graph.edge(k).from, graph.edge(k).from);
      EXPECT_EQ(file.graph.edge(k).to, graph.edge(k).to);
      EXPECT_EQ(file.graph.edge(k).weight, graph.edge(k).weight);
    }
  }
  const auto bytes = read_file(folder / "a.isograph");
  EXPECT_EQ(bytes.size(), 32u + 5 * 8 + 4 * 16);
  for (std::size_t size : {std::size_t{9}, std::size_t{40}, bytes.size() - 1}) {
    EXPECT_THROW(parse(bytes.substr(0, size)), ParseError) << size;
  }
  EXPECT_THROW(parse(bytes + "x"), ParseError);
  EXPECT_THROW(write_binary_graph(folder / "b", graph, {1}), InvalidArgument);
  EXPECT_THROW(write_binary_graph(folder / "b", graph, {1, 2, 3, 4, 4}), InvalidArgument);
}

TEST(MergeDirections, MakesBothDirectionsOfAnEdgeOne) {
  const std::string text = "from,to,weight\n1,2,3\n2,3,1\n2,1,3\n3,2,2\n1,2,5\n4,4,1\n4,4,1\n";
  auto file = parse(text);
  merge_directions(file);
  ASSERT_EQ(file.graph.edge_count(), 5);  // the repeated direction is an edge of its own
  EXPECT_EQ(file.graph.edge(0).weight, 3.0);
  EXPECT_EQ(file.graph.edge(1).weight, 1.5);
  EXPECT_EQ(file.graph.edge(2).weight, 5.0);
  EXPECT_EQ(file.report.notes.at("edge in both directions"), 1u);
  EXPECT_EQ(file.report.repairs.at("edge with two weights"), 1u);
  auto strict = parse(text);
  EXPECT_THROW(merge_directions(strict, {.strict = true}), ParseError);
}

}  // namespace
}  // namespace isotherm::spectral
