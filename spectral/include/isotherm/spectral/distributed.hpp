#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "isotherm/base/read_report.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/spectral/edges/multiscale_heat.hpp"
#include "isotherm/spectral/eigen/embed.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"
#include "isotherm/spectral/types.hpp"

/// The spectral engine for graphs that outgrow one machine, on PETSc and SLEPc: a library of its
/// own, isotherm::distributed (docs/distributed.md). Processes started together by mpirun, its
/// *ranks*, each hold a part of the graph and of every vector.
///
/// All functions are collective: every rank calls them, in the same order and with the same
/// options. What one rank cannot do, none can: they throw the same error on every rank.
///
///     int main(int argc, char** argv) {
///       using namespace isotherm::spectral;
///       distributed::Session session;
///       const auto graph = distributed::Graph::read(session, argv[1]);
///       const auto result = distributed::embed(graph, {.dimensions = 3});
///       distributed::RankStream out(session, "rows.csv");
///       out.append(text_of(result.rows, graph.ids()));  // of this rank's vertices
///       out.commit();
///     }
namespace isotherm::spectral::distributed {

/// MPI, PETSc and SLEPc, from here to its end. One a process.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  int rank() const noexcept;
  int size() const noexcept;

  /// The sum over all ranks. Collective.
  std::int64_t sum(std::int64_t mine) const;

  /// The most memory that any rank has had until now, in bytes. Collective.
  std::int64_t peak_memory() const;

  /// Runs `work` on this rank; where it throws on some ranks, all throw the error of the first.
  void together(const std::function<void()>& work) const;

  /// How a program ends: all ranks call it, with what they would return and what there is to say
  /// of it. Gives the worst of all codes once every rank is here, and has the first rank that is
  /// of this code say its message. A rank with an error that waits in vain for others, which wait
  /// for it within a computation, ends them all with its message after two seconds.
  int agree_on_end(int code, const std::string& message,
                   const std::function<void(std::string_view)>& say) const;

  struct State;
  const State& state() const noexcept { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

/// A file that is written by all ranks: what they append, in order of rank, call by call.
/// Rank 0 has the file, and pieces of the others' text in turn.
class RankStream {
 public:
  /// @throws FileError
  RankStream(const Session& session, const std::string& path);
  ~RankStream();

  void append(std::string_view text);

  /// Gives the file its name. @throws FileError
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

enum class Partitioner {
  scotch,  ///< PT-Scotch: few edges between ranks
  none,    ///< vertices in order of their numbers
};

constexpr std::array<EnumName<Partitioner>, 2> enum_names(Partitioner) {
  return {{{Partitioner::scotch, "scotch"}, {Partitioner::none, "none"}}};
}

struct GraphOptions {
  /// Small graphs (fewer than a thousand vertices a rank) are not partitioned.
  Partitioner partitioner = Partitioner::scotch;
  bool strict = false;  ///< repairs of the input are errors
};

/// An edge in the order of the file.
struct FileOrderEdge {
  std::int64_t number = 0;  ///< from 0, both directions of an edge counted once
  Index from = 0;           ///< positions
  Index to = 0;
  double weight = 0.0;
};

/// A weighted graph of which every rank has a part.
///
/// Vertices are named by their positions in ascending order of the file's numbers, as those of
/// WeightedGraph, and each rank answers for a block of them. Edges that are repeated add up in the
/// Laplacian; of a file, both directions of an edge are one edge, as with merge_directions().
class Graph {
 public:
  /// Every rank reads its part of the file: rows `from,to[,weight]` or `from to [weight]`, a
  /// MatrixMarket matrix of which one triangle is stored, g2o (edges of weight 1), or what
  /// write_binary_graph() wrote.
  /// @throws FileError, ParseError naming the line; InvalidArgument for a file that cannot be read
  ///   in parts: compressed, or a stream
  static Graph read(const Session& session, const std::string& path,
                    const GraphOptions& options = {});

  /// Of edges that each rank has some of; together, in order of rank, they are the file.
  /// Vertices are numbered by themselves. @throws InvalidArgument
  static Graph from_edges(const Session& session, Index vertex_count,
                          std::span<const WeightedEdge> edges, const GraphOptions& options = {});

  ~Graph();
  Graph(Graph&&) noexcept;
  Graph& operator=(Graph&&) noexcept;

  Index vertex_count() const noexcept;
  std::int64_t edge_count() const noexcept;  ///< both directions counted once
  std::int64_t component_count() const noexcept;
  /// Edges between vertices of two ranks, as a share of all.
  double cut() const noexcept;
  const ReadReport& report() const noexcept;

  /// First position of this rank's block of vertices, and the file's numbers of these.
  Index block_begin() const noexcept;
  std::span<const std::uint64_t> ids() const noexcept;

  /// The file's numbers of any positions, each rank asking for its own.
  std::vector<std::uint64_t> ids_of(std::span<const Index> positions) const;

  /// Positions of vertices that the file numbers so. @throws InvalidArgument for a number that
  /// the graph does not have
  std::vector<Index> positions_of(std::span<const std::uint64_t> ids) const;

  /// This rank's part of the edges, in order of the file over the ranks.
  std::vector<FileOrderEdge> edges() const;

  /// The graph on the same vertices with only those of this rank's edges() whose `keep` entry is
  /// true. @throws InvalidArgument unless `keep` has one entry per edge
  Graph filtered(const std::vector<bool>& keep) const;

  const Session& session() const noexcept;

  struct State;
  const State& state() const noexcept { return *state_; }

 private:
  explicit Graph(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

enum class EigenSolver {
  automatic,     ///< shift-invert, or LOBPCG where its factor would not fit `factor_memory`
  shift_invert,  ///< Krylov-Schur on the pseudo-inverse, by MUMPS; inertia counts what was missed
  lobpcg,        ///< preconditioned by algebraic multigrid; nothing counts what was missed
};

constexpr std::array<EnumName<EigenSolver>, 3> enum_names(EigenSolver) {
  return {{{EigenSolver::automatic, "automatic"},
           {EigenSolver::shift_invert, "shift-invert"},
           {EigenSolver::lobpcg, "lobpcg"}}};
}

struct SolverOptions {
  EigenSolver eigen_solver = EigenSolver::automatic;
  /// What MUMPS may take on each rank by its own estimate, in GiB. 0: half of the memory that is
  /// free on the machine, divided among its ranks.
  double factor_memory = 0.0;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, SolverOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("eigen_solver", options.eigen_solver, "how eigenpairs are computed");
  visit("factor_memory", options.factor_memory,
        "GiB a rank may take for a factorisation; 0: half of what is free", closed(0, 1e6));
}

/// The `options.count` smallest eigenpairs, as smallest_eigenpairs() gives them, but `vectors` has
/// the rows of this rank's block. `options.method` and `dense_limit` play no part.
/// @throws InvalidArgument, NumericalError, Cancelled
EigenDecomposition smallest_eigenpairs(const Graph& graph, LaplacianKind kind,
                                       const EigenOptions& options = {},
                                       const SolverOptions& solver = {});

/// Which solver found eigenpairs is in the second; rows are those of this rank's block.
struct EmbedResult : spectral::EmbedResult {
  EigenSolver solver = EigenSolver::automatic;
};

/// Coordinates of every vertex, as spectral::embed().
EmbedResult embed(const Graph& graph, const EmbedOptions& options = {},
                  const SolverOptions& solver = {}, const ProgressCallback& progress = {});

/// Heat distances of the pairs of positions that this rank asks for, at the same scales on every
/// rank, as spectral::heat_distances(): certified brackets, by Lanczos. `options.method` and
/// `threads` play no part.
///
/// What a pair can reach in a few steps is brought to one rank, which goes on as on one machine;
/// pairs that reach further than a rank's share of the graph are iterated for together, each
/// vector over all ranks.
/// @throws InvalidArgument, Cancelled
HeatDistanceResult heat_distances(const Graph& graph, std::span<const VertexPair> pairs,
                                  std::span<const double> scales,
                                  const HeatDistanceOptions& options = {});

struct ResistanceOptions {
  /// Of each resistance, relative: width of its bracket; in (0, 1).
  double tolerance = 1e-6;
  int max_iterations = 1000;
  SolverOptions solver = {};  ///< of the smallest eigenvalue that is not null, for the brackets
  ProgressCallback progress = {};
};

/// Effective resistances with brackets.
struct ResistanceResult {
  std::vector<CertifiedValue> values;  ///< one a pair; +infinity between components
  /// The lower bound of the smallest eigenvalue that is not null which upper bounds rest on, and
  /// whether an inertia count proves it.
  double smallest_eigenvalue = 0.0;
  bool proven = false;
  std::int64_t unconverged = 0;
  double seconds = 0.0;
};

/// Resistances of the pairs of positions that this rank asks for: conjugate gradients,
/// preconditioned by algebraic multigrid, a solve a pair. The energy of what was solved for is a
/// lower bound, and |residual|^2 over the smallest eigenvalue what it may lack.
ResistanceResult effective_resistances(const Graph& graph, std::span<const VertexPair> pairs,
                                       const ResistanceOptions& options = {});

struct ProjectionOptions {
  /// All resistances are within this share of the true ones; in (0, 1).
  double error = 0.3;
  /// Probability that they are not; in (0, 1).
  double failure = 0.01;
  std::uint64_t seed = 0;
  ProgressCallback progress = {};
};

/// Resistances of all edges from random projections of their flows (D. Spielman, N. Srivastava,
/// "Graph sparsification by effective resistances", 2011): ln(2 m / failure) / (e^2 / 4 - e^3 / 6)
/// solves for m edges and error e. In order of edges().
struct ProjectedResistances {
  std::vector<double> values;
  std::int64_t solves = 0;
  double seconds = 0.0;
};
ProjectedResistances project_resistances(const Graph& graph, const ProjectionOptions& options = {});

/// Which of edges() are bridges: their removal parts their component.
std::vector<bool> find_bridges(const Graph& graph);

/// Algorithm 1, as spectral::multiscale_heat(), on those of this rank's edges() of which
/// `candidate` says so; a verdict for each of edges(), also where it is no candidate. Thresholds
/// other than mean-sigma see all distances: 8 bytes a candidate on every rank. `rounds` are the
/// same on all ranks; `distances` are left empty.
/// @throws InvalidArgument, Cancelled
MultiscaleHeat multiscale_heat(const Graph& graph, const std::vector<bool>& candidate,
                               const MultiscaleHeatOptions& options = {},
                               const RunContext& run = {});

}  // namespace isotherm::spectral::distributed
