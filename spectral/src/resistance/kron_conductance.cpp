#include "resistance/kron_conductance.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace isotherm::spectral::detail {
namespace {

/// Conductances between some vertices: those of (a, b), a > b.
struct Mesh {
  std::size_t order = 0;
  std::vector<double> values;  // by rows; only below the diagonal

  explicit Mesh(std::size_t count) : order(count), values(count * count, 0.0) {}

  double* row(std::size_t a) { return values.data() + a * order; }
  const double* row(std::size_t a) const { return values.data() + a * order; }
  double between(std::size_t a, std::size_t b) const { return a > b ? row(a)[b] : row(b)[a]; }
};

/// Replaces the star around the last vertex by a mesh of its neighbours.
void eliminate_last(Mesh& mesh, std::size_t last) {
  const double* star = mesh.row(last);
  const double sum = std::accumulate(star, star + last, 0.0);
  if (sum == 0.0) return;
  for (std::size_t a = 1; a < last; ++a) {
    if (star[a] == 0.0) continue;
    const double share = star[a] / sum;
    double* target = mesh.row(a);
    for (std::size_t b = 0; b < a; ++b) target[b] += share * star[b];
  }
}

/// What is left between the vertices `kept` (ascending) when all others are eliminated.
Mesh reduce(const Mesh& mesh, std::span<const std::size_t> kept) {
  if (kept.size() == mesh.order) return mesh;
  std::vector<std::size_t> order(kept.begin(), kept.end());
  for (std::size_t a = 0, next = 0; a < mesh.order; ++a) {
    if (next < kept.size() && kept[next] == a) {
      ++next;
    } else {
      order.push_back(a);
    }
  }
  Mesh work(mesh.order);
  for (std::size_t a = 0; a < mesh.order; ++a) {
    for (std::size_t b = 0; b < a; ++b) work.row(a)[b] = mesh.between(order[a], order[b]);
  }
  for (std::size_t last = mesh.order - 1; last >= kept.size() && last > 1; --last) {
    eliminate_last(work, last);
  }
  Mesh left(kept.size());
  for (std::size_t a = 1; a < kept.size(); ++a) std::copy_n(work.row(a), a, left.row(a));
  return left;
}

/// A part of a front, which says something about its rows and wants to know what all other parts
/// say about them.
struct Part {
  std::vector<std::size_t> rows;  // of the front, ascending
  const Mesh* says = nullptr;     // about its rows, of a child
  double direct = 0.0;            // the same of a pair
  Index child = FrontTree::kNone;
  Index pair = -1;
};

/// Adds what a part says; `place` leads from rows of the front to those of the mesh.
void add(const Part& part, const std::vector<std::size_t>& place, Mesh& mesh) {
  if (part.says == nullptr) {
    mesh.row(place[part.rows[1]])[place[part.rows[0]]] += part.direct;
    return;
  }
  for (std::size_t a = 1; a < part.rows.size(); ++a) {
    double* target = mesh.row(place[part.rows[a]]);
    for (std::size_t b = 0; b < a; ++b) target[place[part.rows[b]]] += part.says->row(a)[b];
  }
}

class KronReduction {
 public:
  KronReduction(const FrontTree& tree, const std::vector<std::vector<PairOfFront>>& pairs,
                std::size_t pair_count)
      : tree_(tree), pairs_(pairs), children_(tree.front_count()), rest_(pair_count, 0.0) {
    for (Index s = 0; s < tree.front_count(); ++s) {
      if (tree.parent(s) != FrontTree::kNone) children_[tree.parent(s)].push_back(s);
      from_below_.emplace_back(0);
      from_above_.emplace_back(0);
    }
  }

  std::vector<double> run() && {
    for (Index s = 0; s < tree_.front_count(); ++s) gather(s);
    for (Index s = tree_.front_count() - 1; s >= 0; --s) scatter(s);
    return std::move(rest_);
  }

 private:
  std::vector<Part> parts(Index front) const {
    std::vector<Part> parts;
    for (const Index child : children_[front]) {
      const auto place = tree_.place_in_parent(child);
      parts.push_back({{place.begin(), place.end()}, &from_below_[child], 0.0, child, -1});
    }
    for (const auto& pair : pairs_[front]) {
      const auto first = static_cast<std::size_t>(pair.first);
      const auto second = static_cast<std::size_t>(pair.second);
      parts.push_back({{first, second}, nullptr, pair.direct, FrontTree::kNone, pair.pair});
    }
    return parts;
  }

  static std::vector<std::size_t> counting(std::size_t from, std::size_t to) {
    std::vector<std::size_t> numbers(to - from);
    std::iota(numbers.begin(), numbers.end(), from);
    return numbers;
  }

  /// What a front and all below it say about the rows it shares with its parent.
  void gather(Index front) {
    const auto size = static_cast<std::size_t>(tree_.size(front));
    const auto width = static_cast<std::size_t>(tree_.width(front));
    if (width == size) return;
    Mesh mesh(size);
    const auto place = counting(0, size);
    for (const auto& part : parts(front)) add(part, place, mesh);
    from_below_[front] = reduce(mesh, counting(width, size));
  }

  /// Tells each part of a front what all others say.
  void scatter(Index front) {
    const auto size = static_cast<std::size_t>(tree_.size(front));
    const auto width = static_cast<std::size_t>(tree_.width(front));
    Mesh mesh(size);
    const auto& above = from_above_[front];
    for (std::size_t a = 1; a < above.order; ++a) {
      std::copy_n(above.row(a), a, mesh.row(width + a) + width);
    }
    auto all = parts(front);
    if (!all.empty()) share(std::move(mesh), counting(0, size), all);
    from_above_[front] = Mesh(0);
  }

  /// `mesh`, between `rows` of the front, is what all say that are not among `parts`.
  void share(Mesh mesh, std::vector<std::size_t> rows, std::span<Part> parts) {
    const auto kept = touched(rows, parts);
    if (kept.size() < rows.size()) {
      mesh = reduce(mesh, kept);
      for (std::size_t k = 0; k < kept.size(); ++k) rows[k] = rows[kept[k]];
      rows.resize(kept.size());
    }
    if (parts.size() == 1) {
      tell(parts.front(), std::move(mesh));
      return;
    }
    const std::size_t middle = halve(parts);
    std::vector<std::size_t> place(rows.back() + 1, 0);
    for (std::size_t k = 0; k < rows.size(); ++k) place[rows[k]] = k;
    Mesh other = mesh;
    for (const auto& part : parts.first(middle)) add(part, place, other);
    for (const auto& part : parts.subspan(middle)) add(part, place, mesh);
    share(std::move(other), rows, parts.subspan(middle));
    share(std::move(mesh), std::move(rows), parts.first(middle));
  }

  /// Which of `rows` some part has.
  static std::vector<std::size_t> touched(const std::vector<std::size_t>& rows,
                                          std::span<const Part> parts) {
    std::vector<bool> has(rows.back() + 1, false);
    for (const auto& part : parts) {
      for (const std::size_t row : part.rows) has[row] = true;
    }
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (has[rows[k]]) found.push_back(k);
    }
    return found;
  }

  /// Orders parts by their first rows or their last, whichever differ more, so that halves have
  /// few rows.
  static std::size_t halve(std::span<Part> parts) {
    const auto range = [&](auto key) {
      const auto [low, high] =
          std::minmax_element(parts.begin(), parts.end(),
                              [&](const Part& a, const Part& b) { return key(a) < key(b); });
      return key(*high) - key(*low);
    };
    const auto first = [](const Part& part) { return part.rows.front(); };
    const auto last = [](const Part& part) { return part.rows.back(); };
    const bool by_first = range(first) >= range(last);
    const auto key = [&](const Part& part) {
      return std::tuple(by_first ? first(part) : last(part), part.child, part.pair);
    };
    std::sort(parts.begin(), parts.end(),
              [&](const Part& a, const Part& b) { return key(a) < key(b); });
    return parts.size() / 2;
  }

  void tell(const Part& part, Mesh mesh) {
    if (part.child == FrontTree::kNone) {
      rest_[part.pair] = mesh.row(1)[0];
    } else {
      from_above_[part.child] = std::move(mesh);
      from_below_[part.child] = Mesh(0);
    }
  }

  const FrontTree& tree_;
  const std::vector<std::vector<PairOfFront>>& pairs_;
  std::vector<std::vector<Index>> children_;
  std::vector<Mesh> from_below_, from_above_;  // by front, between the rows it shares
  std::vector<double> rest_;
};

}  // namespace

std::vector<double> rest_conductances(const FrontTree& tree,
                                      const std::vector<std::vector<PairOfFront>>& pairs,
                                      std::size_t pair_count) {
  return KronReduction(tree, pairs, pair_count).run();
}

double kron_rounding(const FrontTree& tree, std::size_t pair_count) {
  // Each vertex is eliminated once on the way to a pair: a sum, a quotient, a product and a sum;
  // and each part is added once at most.
  double largest = 0.0;
  for (Index s = 0; s < tree.front_count(); ++s) {
    largest = std::max(largest, static_cast<double>(tree.size(s)));
  }
  const double eliminations = static_cast<double>(tree.block_count()) * (largest + 4.0);
  const double additions = static_cast<double>(pair_count) + tree.front_count() + 4.0;
  return std::numeric_limits<double>::epsilon() * (eliminations + additions);
}

}  // namespace isotherm::spectral::detail
