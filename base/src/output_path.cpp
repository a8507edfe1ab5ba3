#include "isotherm/base/output_path.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

#include "isotherm/base/error.hpp"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

// The file a symbolic link points to, there or not, so that renaming does not replace the
// link.
std::string resolve_links(const std::string& path) {
  constexpr int kLongestChain = 40;  // as the kernel has it
  fs::path target = path;
  std::error_code problem;
  for (int links = 0; links < kLongestChain; ++links) {
    if (!fs::is_symlink(fs::symlink_status(target, problem))) break;
    const auto next = fs::read_symlink(target, problem);
    if (problem) break;
    target = target.parent_path() / next;  // `next` alone where that is absolute
  }
  return target.string();
}

[[noreturn]] void fail(const std::string& path, int problem) {
  throw FileError(path, std::string("cannot be written: ") + std::strerror(problem));
}

void require_writable_stdout() {
  const int flags = ::fcntl(STDOUT_FILENO, F_GETFL);
  if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) fail("<stdout>", EBADF);
}

}  // namespace

std::string output_target(const std::string& path) {
  if (path == "-") return path;
  std::error_code problem;
  const auto whole = fs::absolute(resolve_links(path), problem);
  const auto target = problem ? whole : fs::weakly_canonical(whole, problem);
  return problem ? path : target.string();
}

bool is_endless_link(const std::string& path) {
  std::error_code problem;
  static_cast<void>(fs::status(path, problem));
  return problem == std::errc::too_many_symbolic_link_levels;
}

void require_writable(const std::string& path) {
  if (path.empty()) throw FileError(path, "cannot be written: empty name");
  if (path == "-") return require_writable_stdout();
  std::error_code ignored;
  if (is_endless_link(path)) fail(path, ELOOP);
  const auto status = fs::status(path, ignored);
  if (fs::is_directory(status)) fail(path, EISDIR);
  const bool in_place = fs::exists(status) && !fs::is_regular_file(status);
  const std::string needed =
      in_place ? path : fs::absolute(resolve_links(path), ignored).parent_path().string();
  if (::access(needed.c_str(), in_place ? W_OK : W_OK | X_OK) != 0) fail(path, errno);
  if (!in_place && !fs::is_directory(needed, ignored)) fail(path, ENOTDIR);
}

}  // namespace isotherm
