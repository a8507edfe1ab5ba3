#include <algorithm>
#include <optional>

#include "distributed/support/session.hpp"
#include "isotherm/base/text_writer.hpp"

namespace isotherm::spectral::distributed {
namespace {

constexpr std::int64_t kPiece = std::int64_t{1} << 23;  // bytes on their way at once
constexpr int kTag = 28;

}  // namespace

struct RankStream::State {
  const detail::Comm& comm;
  std::optional<OutputFile> file;  // on rank 0

  void receive(int from, std::int64_t size) {
    std::string piece;
    while (size > 0) {
      piece.resize(static_cast<std::size_t>(std::min(size, kPiece)));
      MPI_Recv(piece.data(), static_cast<int>(piece.size()), MPI_CHAR, from, kTag, comm.handle,
               MPI_STATUS_IGNORE);
      file->write(piece);
      size -= static_cast<std::int64_t>(piece.size());
    }
  }

  void send(std::string_view text) const {
    while (!text.empty()) {
      const auto piece = text.substr(0, kPiece);
      MPI_Ssend(piece.data(), static_cast<int>(piece.size()), MPI_CHAR, 0, kTag, comm.handle);
      text.remove_prefix(piece.size());
    }
  }
};

RankStream::RankStream(const Session& session, const std::string& path)
    : state_(new State{session.state().comm, {}}) {
  session.together([&] {
    if (session.rank() == 0) state_->file.emplace(path);
  });
}

RankStream::~RankStream() = default;

void RankStream::append(std::string_view text) {
  const auto& comm = state_->comm;
  const auto sizes = detail::gather_all(comm, static_cast<std::int64_t>(text.size()));
  if (comm.rank != 0) return state_->send(text);
  state_->file->write(text);
  for (int from = 1; from < comm.size; ++from) state_->receive(from, sizes[from]);
}

void RankStream::commit() {
  detail::together(state_->comm, [this] {
    if (state_->file) state_->file->commit();
  });
}

}  // namespace isotherm::spectral::distributed
