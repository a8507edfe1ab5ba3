#include "distributed/support/session.hpp"

#include <array>
#include <chrono>
#include <thread>

#include <sys/resource.h>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral::distributed {
namespace {

constexpr auto kPatience = std::chrono::seconds(2);
constexpr auto kPause = std::chrono::milliseconds(1);

/// Whether the request is done, or will not be soon.
bool wait_for(MPI_Request& request, bool forever) {
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return true;
    if (!forever && std::chrono::steady_clock::now() - start > kPatience) return false;
    std::this_thread::sleep_for(kPause);
  }
}

detail::Comm comm_of(MPI_Comm handle) {
  detail::Comm comm{handle};
  MPI_Comm_rank(handle, &comm.rank);
  MPI_Comm_size(handle, &comm.size);
  return comm;
}

}  // namespace

Session::Session() : state_(std::make_unique<State>()) {
  // Signals are for the program.
  static std::array<char, 9> name = {"isotherm"};
  static std::array<char, 19> plain = {"-no_signal_handler"};
  static std::array<char*, 3> words = {name.data(), plain.data(), nullptr};
  int count = 2;
  char** arguments = words.data();
  if (SlepcInitialize(&count, &arguments, nullptr, nullptr) != 0) {
    throw NumericalError("petsc", "cannot be started");
  }
  detail::keep_petsc_messages();
  state_->comm = comm_of(PETSC_COMM_WORLD);
  MPI_Comm ending = MPI_COMM_NULL;
  MPI_Comm_dup(PETSC_COMM_WORLD, &ending);
  state_->ending = comm_of(ending);
}

Session::~Session() {
  MPI_Comm_free(&state_->ending.handle);
  SlepcFinalize();
}

int Session::rank() const noexcept { return state_->comm.rank; }
int Session::size() const noexcept { return state_->comm.size; }

std::int64_t Session::sum(std::int64_t mine) const { return detail::sum(state_->comm, mine); }

std::int64_t Session::peak_memory() const {
  struct rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return detail::most(state_->comm, std::int64_t{1024} * usage.ru_maxrss);
}

void Session::together(const std::function<void()>& work) const {
  detail::together(state_->comm, work);
}

int Session::agree_on_end(int code, const std::string& message,
                          const std::function<void(std::string_view)>& say) const {
  const auto& comm = state_->ending;
  struct {
    int code;
    int rank;
  } mine{code, comm.rank}, worst{};
  MPI_Request request{};
  MPI_Iallreduce(&mine, &worst, 1, MPI_2INT, MPI_MAXLOC, comm.handle, &request);
  if (!wait_for(request, code == 0)) {
    say("rank " + std::to_string(comm.rank) + ": " + message);
    MPI_Abort(comm.handle, code);
  }
  if (worst.rank == comm.rank && code != 0) say(message);
  return worst.code;
}

}  // namespace isotherm::spectral::distributed
