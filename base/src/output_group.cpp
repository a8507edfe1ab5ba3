#include "isotherm/base/output_group.hpp"

#include <atomic>
#include <utility>
#include <vector>

#include "temporary_file.hpp"

namespace isotherm {

struct OutputGroup::State {
  std::vector<detail::TemporaryFile> files;
};

namespace {

thread_local OutputGroup* current_group = nullptr;
std::atomic<bool> taking_place{false};

// Also where a name cannot be given.
struct TakingPlace {
  TakingPlace() { taking_place = true; }
  ~TakingPlace() { taking_place = false; }
};

}  // namespace

OutputGroup::OutputGroup() : state_(std::make_unique<State>()) { current_group = this; }

OutputGroup::~OutputGroup() { current_group = nullptr; }

bool OutputGroup::take(detail::TemporaryFile& file) {
  if (current_group == nullptr) return false;
  current_group->state_->files.push_back(std::move(file));
  return true;
}

void OutputGroup::commit() {
  const TakingPlace guard;
  for (auto& file : state_->files) file.take_place();
  state_->files.clear();
}

bool outputs_taking_place() noexcept { return taking_place; }

}  // namespace isotherm
