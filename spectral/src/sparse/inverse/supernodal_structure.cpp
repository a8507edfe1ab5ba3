#include "sparse/inverse/supernodal_structure.hpp"

#include <algorithm>
#include <memory>
#include <string>

#include <cholmod.h>

#include "isotherm/base/error.hpp"
#include "sparse/cholmod_view.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr Index kNone = -1;

std::vector<Index> copy_indices(const void* source, std::size_t count) {
  const auto* begin = static_cast<const int*>(source);
  return {begin, begin + count};
}

/// Ordering and supernodes as CHOLMOD finds them.
void copy_analysis(const SparseMatrix& lower, SupernodalStructure& structure) {
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  common.supernodal = CHOLMOD_SUPERNODAL;
  auto view = cholmod_lower_view(lower);
  cholmod_factor* factor = cholmod_analyze(&view, &common);
  const bool good = factor != nullptr && common.status == CHOLMOD_OK && factor->is_super != 0;
  if (good) {
    const auto* order = static_cast<const int*>(factor->Perm);
    structure.position_of.resize(factor->n);
    for (std::size_t k = 0; k < factor->n; ++k) {
      structure.position_of[order[k]] = static_cast<Index>(k);
    }
    structure.first_column = copy_indices(factor->super, factor->nsuper + 1);
    structure.row_start = copy_indices(factor->pi, factor->nsuper + 1);
    structure.rows = copy_indices(factor->s, factor->ssize);
    structure.flops = common.fl;
    structure.entries = common.lnz;
  }
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
  if (!good) throw NumericalError("factorisation", "symbolic analysis failed");
}

void link_fronts(SupernodalStructure& structure) {
  const Index count = structure.supernode_count();
  auto& supernode_of = structure.supernode_of;
  supernode_of.resize(structure.size);
  for (Index s = 0; s < count; ++s) {
    for (Index c = structure.first_column[s]; c < structure.first_column[s + 1]; ++c) {
      supernode_of[c] = s;
    }
  }
  structure.parent.assign(count, kNone);
  structure.child_count.assign(count, 0);
  structure.place_in_parent.assign(structure.rows.size(), 0);
  structure.block_start.assign(count + 1, 0);
  for (Index s = 0; s < count; ++s) {
    const std::int64_t front = structure.front_size(s);
    structure.largest_front = std::max(structure.largest_front, static_cast<Index>(front));
    structure.block_start[s + 1] = structure.block_start[s] + front * structure.width(s);
    const Index outside = structure.row_start[s] + structure.width(s);
    if (outside == structure.row_start[s + 1]) continue;
    const Index parent = supernode_of[structure.rows[outside]];
    structure.parent[s] = parent;
    ++structure.child_count[parent];
    Index place = structure.row_start[parent];
    for (Index k = outside; k < structure.row_start[s + 1]; ++k) {
      while (structure.rows[place] != structure.rows[k]) ++place;
      structure.place_in_parent[k] = place - structure.row_start[parent];
    }
  }
}

void reorder_entries(const SparseMatrix& lower, SupernodalStructure& structure) {
  const auto& position_of = structure.position_of;
  structure.entry_start.assign(structure.size + 1, 0);
  const auto for_each_entry = [&](auto&& visit) {
    for (Index column = 0; column < lower.outerSize(); ++column) {
      for (SparseMatrix::InnerIterator entry(lower, column); entry; ++entry) {
        const Index a = position_of[column];
        const Index b = position_of[entry.row()];
        visit(std::min(a, b), std::max(a, b), entry.value());
      }
    }
  };
  for_each_entry([&](Index column, Index, double) { ++structure.entry_start[column + 1]; });
  for (Index c = 0; c < structure.size; ++c) {
    structure.entry_start[c + 1] += structure.entry_start[c];
  }
  structure.entry_row.resize(structure.entry_start.back());
  structure.entry_value.resize(structure.entry_start.back());
  auto next = structure.entry_start;
  for_each_entry([&](Index column, Index row, double value) {
    structure.entry_row[next[column]] = row;
    structure.entry_value[next[column]++] = value;
  });
}

}  // namespace

SupernodalStructure analyse(const SparseMatrix& lower) {
  SupernodalStructure structure;
  structure.size = static_cast<Index>(lower.rows());
  structure.first_column = {0};
  structure.row_start = {0};
  structure.entry_start = {0};
  if (structure.size == 0) return structure;
  copy_analysis(lower, structure);
  link_fronts(structure);
  reorder_entries(lower, structure);
  return structure;
}

FrontQueries locate(const SupernodalStructure& structure, std::span<const VertexPair> pairs) {
  struct Located {
    Index supernode;
    FrontQuery query;
  };
  const auto front_place = [&](Index s, Index row) {
    const auto begin = structure.rows.begin() + structure.row_start[s];
    const auto end = structure.rows.begin() + structure.row_start[s + 1];
    const auto found = std::lower_bound(begin, end, row);
    if (found == end || *found != row) {
      throw InvalidArgument("pairs", "a pair lies outside the pattern of the factor");
    }
    return static_cast<Index>(found - begin);
  };

  std::vector<Located> located;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    auto [low, high] = pairs[k];
    if (low < 0) std::swap(low, high);
    if (low < 0) continue;
    low = structure.position_of[low];
    if (high >= 0) high = structure.position_of[high];
    const bool swapped = high >= 0 && high < low;
    if (swapped) std::swap(low, high);
    const Index s = structure.supernode_of[low];
    const Index second = high < 0 ? kNone : front_place(s, high);
    located.push_back({s, {static_cast<Index>(k), front_place(s, low), second, swapped}});
  }

  FrontQueries result;
  result.start.assign(structure.supernode_count() + 1, 0);
  for (const auto& item : located) ++result.start[item.supernode + 1];
  for (std::size_t s = 1; s < result.start.size(); ++s) result.start[s] += result.start[s - 1];
  result.queries.resize(located.size());
  auto next = result.start;
  for (const auto& item : located) result.queries[next[item.supernode]++] = item.query;
  return result;
}

}  // namespace isotherm::spectral::detail
