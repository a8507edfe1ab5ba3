#include "isotherm/slam/io/pose_graph_stream.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <istream>
#include <iterator>
#include <string_view>
#include <utility>

#include "io/graph_draft.hpp"
#include "io/incremental/irl_reader.hpp"
#include "io/incremental/jrl_reader.hpp"
#include "isotherm/slam/io/file_format.hpp"

namespace isotherm::slam {
namespace {

template <class Pose>
void add_entries(const detail::GraphDraft<Pose>& draft, const std::string& path,
                 std::deque<StreamEntry>& entries) {
  if (!draft.indefinite.empty()) {
    const auto& found = draft.indefinite.front();
    throw ParseError({path, draft.constraints[found.constraint].line, found.column}, found.token,
                     "information matrix is not positive semi-definite");
  }
  for (const auto& vertex : draft.vertices) {
    entries.push_back(StreamVertex<Pose>{vertex.id, vertex.pose});
  }
  for (std::size_t k = 0; k < draft.constraints.size(); ++k) {
    const auto [from, to] = draft.end_ids[k];
    StreamEdge<Pose> edge{from, to, draft.constraints[k]};
    if (!draft.correct.empty()) edge.correct = draft.correct[k];
    entries.push_back(std::move(edge));
  }
}

}  // namespace

class PoseGraphStream::Reader {
 public:
  Reader(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}

  std::optional<StreamEntry> next() {
    if (!std::exchange(started_, true)) start();
    while (entries_.empty()) {
      if (!text_ || !text_->next_line()) return std::nullopt;
      take(read_line_());
    }
    StreamEntry entry = std::move(entries_.front());
    entries_.pop_front();
    return entry;
  }

  std::uint64_t line_number() const { return text_ ? text_->line_number() : 0; }

 private:
  // An IRL file tells itself by its first five lines, a JRL file by its first letter.
  void start() {
    for (int k = 0; k < detail::IrlHeader::kLines; ++k) {
      std::string line;
      if (!std::getline(in_, line)) break;
      ahead_ += line + '\n';
    }
    if (detail::is_jrl(ahead_)) return take_whole();
    const auto header = detail::irl_header(ahead_);
    if (header) ahead_.clear();
    text_.emplace(
        name_, [this](std::span<char> target) { return fill(target); },
        header ? detail::IrlHeader::kLines : 0);
    if (header) {
      read_line_ = [this, header] {
        detail::FileDraft draft;
        detail::IrlEntries(*text_, *header, options_, draft).read();
        return draft;
      };
    } else {
      read_line_ = detail::line_reader(*text_, FileFormat::g2o, options_);
    }
  }

  // In a JRL file one robot stands behind the other.
  void take_whole() {
    ahead_.append(std::istreambuf_iterator<char>(in_), {});
    take(detail::read_jrl(name_, ahead_, options_));
  }

  // As much as one line, so that nothing waits for the next.
  std::size_t fill(std::span<char> target) {
    if (ahead_.empty()) {
      if (!std::getline(in_, ahead_)) return 0;
      ahead_ += '\n';
    }
    const std::size_t count = std::min(target.size(), ahead_.size());
    std::copy_n(ahead_.data(), count, target.data());
    ahead_.erase(0, count);
    return count;
  }

  void take(const detail::FileDraft& draft) {
    for (const auto& held : draft.fixed) entries_.push_back(StreamFixed{held.id});
    add_entries(draft.planar, name_, entries_);
    add_entries(draft.spatial, name_, entries_);
  }

  std::istream& in_;
  std::string name_;
  bool started_ = false;
  std::string ahead_;  // read and not yet handed on
  ReadOptions options_;
  std::optional<TextReader> text_;
  std::function<detail::FileDraft()> read_line_;
  std::deque<StreamEntry> entries_;
};

PoseGraphStream::PoseGraphStream(std::istream& in, std::string name)
    : reader_(std::make_unique<Reader>(in, std::move(name))) {}
PoseGraphStream::~PoseGraphStream() = default;
PoseGraphStream::PoseGraphStream(PoseGraphStream&&) noexcept = default;
PoseGraphStream& PoseGraphStream::operator=(PoseGraphStream&&) noexcept = default;

std::optional<StreamEntry> PoseGraphStream::next() { return reader_->next(); }

std::uint64_t PoseGraphStream::line_number() const { return reader_->line_number(); }

}  // namespace isotherm::slam
