#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

#include "distributed/support/petsc.hpp"
#include "isotherm/spectral/types.hpp"

/// What ranks say to each other.
namespace isotherm::spectral::distributed::detail {

/// All ranks of the session.
struct Comm {
  MPI_Comm handle = MPI_COMM_NULL;
  int rank = 0;
  int size = 1;
};

/// Runs `work` on this rank; where it throws on some ranks, all throw the error of the first.
void together(const Comm& comm, const std::function<void()>& work);

template <class Number>
MPI_Datatype mpi_type() {
  if constexpr (std::is_same_v<Number, double>) return MPI_DOUBLE;
  if constexpr (std::is_same_v<Number, std::int64_t>) return MPI_INT64_T;
  if constexpr (std::is_same_v<Number, std::uint64_t>) return MPI_UINT64_T;
  if constexpr (std::is_same_v<Number, std::int32_t>) return MPI_INT32_T;
}

template <class Number>
Number reduce_all(const Comm& comm, Number value, MPI_Op op) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, mpi_type<Number>(), op, comm.handle);
  return value;
}
template <class Number>
Number sum(const Comm& comm, Number value) {
  return reduce_all(comm, value, MPI_SUM);
}
template <class Number>
Number most(const Comm& comm, Number value) {
  return reduce_all(comm, value, MPI_MAX);
}
template <class Number>
Number least(const Comm& comm, Number value) {
  return reduce_all(comm, value, MPI_MIN);
}
inline bool any(const Comm& comm, bool value) {
  return most(comm, static_cast<std::int32_t>(value)) != 0;
}

inline void sum_each(const Comm& comm, std::span<double> values) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM,
                comm.handle);
}

/// The sum over the ranks before this one.
inline std::int64_t sum_before(const Comm& comm, std::int64_t value) {
  std::int64_t before = 0;
  MPI_Exscan(&value, &before, 1, MPI_INT64_T, MPI_SUM, comm.handle);
  return comm.rank == 0 ? 0 : before;
}

/// The value of every rank.
template <class Item>
std::vector<Item> gather_all(const Comm& comm, const Item& item) {
  static_assert(std::is_trivially_copyable_v<Item>);
  std::vector<Item> all(comm.size);
  MPI_Allgather(&item, sizeof(Item), MPI_BYTE, all.data(), sizeof(Item), MPI_BYTE, comm.handle);
  return all;
}

/// An MPI type of so many bytes, so that counts are of items: 2^31 of them a rank, not bytes.
class ItemType {
 public:
  explicit ItemType(std::size_t size) {
    MPI_Type_contiguous(static_cast<int>(size), MPI_BYTE, &type_);
    MPI_Type_commit(&type_);
  }
  ~ItemType() { MPI_Type_free(&type_); }
  ItemType(const ItemType&) = delete;
  ItemType& operator=(const ItemType&) = delete;
  MPI_Datatype get() const noexcept { return type_; }

 private:
  MPI_Datatype type_{};
};

/// The items of all ranks on every rank, in order of rank.
template <class Item>
std::vector<Item> concatenate(const Comm& comm, const std::vector<Item>& items) {
  static_assert(std::is_trivially_copyable_v<Item>);
  const auto counts = gather_all(comm, static_cast<int>(items.size()));
  std::vector<int> starts(counts.size(), 0);
  std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
  std::vector<Item> all(static_cast<std::size_t>(starts.back() + counts.back()));
  const ItemType type(sizeof(Item));
  MPI_Allgatherv(items.data(), static_cast<int>(items.size()), type.get(), all.data(),
                 counts.data(), starts.data(), type.get(), comm.handle);
  return all;
}

/// What exchange() brought: items in order of the rank they are from, and how many each sent.
template <class Item>
struct Delivery {
  std::vector<Item> items;
  std::vector<int> counts;
};

/// Sends each item to the rank that `destination` gives for it. Items between two ranks keep
/// their order.
template <class Item, class Destination>
Delivery<Item> exchange(const Comm& comm, std::span<const Item> items, Destination destination) {
  static_assert(std::is_trivially_copyable_v<Item>);
  std::vector<int> counts(comm.size, 0);
  for (const auto& item : items) ++counts[destination(item)];
  std::vector<int> starts(comm.size, 0);
  std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
  std::vector<Item> sorted(items.size());
  auto next = starts;
  for (const auto& item : items) sorted[next[destination(item)]++] = item;

  Delivery<Item> delivery;
  delivery.counts.resize(comm.size);
  MPI_Alltoall(counts.data(), 1, MPI_INT, delivery.counts.data(), 1, MPI_INT, comm.handle);
  std::vector<int> from(comm.size, 0);
  std::exclusive_scan(delivery.counts.begin(), delivery.counts.end(), from.begin(), 0);
  delivery.items.resize(static_cast<std::size_t>(from.back() + delivery.counts.back()));
  const ItemType type(sizeof(Item));
  MPI_Alltoallv(sorted.data(), counts.data(), starts.data(), type.get(), delivery.items.data(),
                delivery.counts.data(), from.data(), type.get(), comm.handle);
  return delivery;
}

/// Sends an answer an item of `delivery` back to where that came from; gives the answers to what
/// this rank had sent, in the order in which `asked` has it.
template <class Answer, class Item, class Destination>
std::vector<Answer> reply(const Comm& comm, const Delivery<Item>& delivery,
                          std::span<const Answer> answers, std::span<const Item> asked,
                          Destination destination) {
  std::vector<int> counts(comm.size, 0);
  for (const auto& item : asked) ++counts[destination(item)];
  std::vector<int> starts(comm.size, 0), from(comm.size, 0);
  std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
  std::exclusive_scan(delivery.counts.begin(), delivery.counts.end(), from.begin(), 0);
  std::vector<Answer> sorted(asked.size());
  const ItemType type(sizeof(Answer));
  MPI_Alltoallv(answers.data(), delivery.counts.data(), from.data(), type.get(), sorted.data(),
                counts.data(), starts.data(), type.get(), comm.handle);
  std::vector<Answer> result;
  result.reserve(asked.size());
  for (const auto& item : asked) result.push_back(sorted[starts[destination(item)]++]);
  return result;
}

/// Numbers from 0 on, of which each rank has a contiguous share.
class Blocks {
 public:
  Blocks() = default;
  /// Shares as even as they can be.
  Blocks(const Comm& comm, std::int64_t total);
  /// Of as many as each rank says.
  static Blocks of_sizes(const Comm& comm, std::int64_t mine);

  std::int64_t total() const { return starts_.back(); }
  std::int64_t begin(int rank) const { return starts_[rank]; }
  std::int64_t end(int rank) const { return starts_[rank + 1]; }
  int owner(std::int64_t number) const {
    return static_cast<int>(std::upper_bound(starts_.begin(), starts_.end(), number) -
                            starts_.begin()) -
           1;
  }

 private:
  std::vector<std::int64_t> starts_ = {0};  // one more than ranks
};

/// Entries of an array of which each rank has its block, for any numbers.
template <class Value>
std::vector<Value> look_up(const Comm& comm, const Blocks& blocks, std::span<const Value> mine,
                           std::span<const Index> wanted) {
  const auto owner = [&](Index number) { return blocks.owner(number); };
  const auto asked = exchange(comm, wanted, owner);
  std::vector<Value> answers;
  answers.reserve(asked.items.size());
  const auto begin = blocks.begin(comm.rank);
  for (const Index number : asked.items) {
    answers.push_back(mine[static_cast<std::size_t>(number - begin)]);
  }
  return reply<Value>(comm, asked, std::span<const Value>(answers), wanted, owner);
}

}  // namespace isotherm::spectral::distributed::detail
