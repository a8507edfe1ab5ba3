#include "localize/firm/found_bodies.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace isotherm::network::detail {

bool FoundBodies::cover(const Nodes& members) const {
  return std::all_of(members.begin(), members.end(),
                     [&](Index v) { return !bodies_of_[v].empty(); });
}

void FoundBodies::begin_body() {
  current_ = bodies_.size();
  bodies_.emplace_back();
  joined_to_.push_back(current_);
  shared_.assign(bodies_.size(), {});
}

FoundBodies::Nodes FoundBodies::join(const Nodes& fresh, std::vector<bool>& firm,
                                     const std::function<bool(const Nodes&)>& is_enough) {
  Nodes joined;
  const auto enter = [&](Index v) {
    for (const auto body : bodies_of_[v]) {
      const auto whole = whole_of(body);
      if (whole == current_ || !note(whole, v) || !is_enough(shared_[whole])) continue;
      for (const Index w : bodies_[whole]) {
        if (!firm[w]) joined.push_back(w);
        firm[w] = true;
      }
      bodies_[whole].clear();
      joined_to_[whole] = current_;
    }
  };
  for (const Index v : fresh) enter(v);
  for (std::size_t k = 0; k < joined.size(); ++k) enter(joined[k]);
  return joined;
}

void FoundBodies::end_body(Nodes nodes) {
  for (const Index v : nodes) {
    auto& bodies = bodies_of_[v];
    const bool is_entered = std::any_of(
        bodies.begin(), bodies.end(), [&](std::size_t body) { return whole_of(body) == current_; });
    if (!is_entered) bodies.push_back(current_);
  }
  bodies_[current_] = std::move(nodes);
}

std::vector<FoundBodies::Nodes> FoundBodies::take() && {
  std::erase_if(bodies_, [](const Nodes& body) { return body.empty(); });
  return std::move(bodies_);
}

std::size_t FoundBodies::whole_of(std::size_t body) {
  while (joined_to_[body] != body) {
    joined_to_[body] = joined_to_[joined_to_[body]];  // or chains would grow long
    body = joined_to_[body];
  }
  return body;
}

// Notes that the new body shares a node with another one. True if there are now enough of them to
// ask, or twice as many as when it was last asked, whether they fix it.
bool FoundBodies::note(std::size_t body, Index node) {
  constexpr std::size_t kLeast = 8;
  auto& shared = shared_[body];
  if (!shared.empty() && shared.back() == node) return false;
  shared.push_back(node);
  return shared.size() >= kLeast && std::has_single_bit(shared.size());
}

}  // namespace isotherm::network::detail
