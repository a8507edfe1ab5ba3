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
std::atomic<bool> in_place{false};

}  // namespace

OutputGroup::OutputGroup() : state_(std::make_unique<State>()) { current_group = this; }

OutputGroup::~OutputGroup() { current_group = nullptr; }

bool OutputGroup::take(detail::TemporaryFile& file) {
  if (current_group == nullptr) return false;
  current_group->state_->files.push_back(std::move(file));
  return true;
}

void OutputGroup::commit() {
  if (state_->files.empty()) return;
  in_place = true;
  try {
    for (auto& file : state_->files) file.take_place();
  } catch (...) {
    in_place = false;
    throw;
  }
  state_->files.clear();
}

bool outputs_in_place() noexcept { return in_place; }

}  // namespace isotherm
