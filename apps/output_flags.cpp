#include "output_flags.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/output_path.hpp"

namespace isotherm::apps {
namespace {

namespace fs = std::filesystem;

// Each stands for one format, whoever writes it; a file with another suffix may hold anything.
constexpr std::array<std::string_view, 13> kKnownSuffixes = {
    ".g2o", ".graph", ".tum",  ".kitti", ".euroc", ".pyfg",    ".mtx",
    ".csv", ".npy",   ".json", ".html",  ".svg",   ".isograph"};

bool contains(const auto& all, std::string_view one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

// Two results may go to a device such as /dev/null, but not to one file or one stream.
bool holds_one_result(const std::string& path) {
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  return path == "-" || !fs::exists(status) || fs::is_regular_file(status);
}

}  // namespace

std::string format_suffix(const std::string& path) {
  fs::path name(path);
  if (name.extension() == ".gz") name.replace_extension();
  return name.extension().string();
}

void require_suffix(const std::string& option, const std::string& path,
                    const std::vector<std::string_view>& written) {
  const std::string suffix = format_suffix(path);
  if (!contains(kKnownSuffixes, suffix) || contains(written, suffix)) return;
  throw InvalidArgument(option, fmt::format("cannot write {} as '{}' says, only {}", suffix, path,
                                            fmt::join(written, ", ")));
}

CLI::Option* OutputFlags::add(CLI::App& verb, const std::string& names, std::string& path,
                              const std::string& help, std::vector<std::string_view> suffixes) {
  CLI::Option* option = verb.add_option(names, path, help)->type_name("FILE");
  outputs_.push_back({option, &path, std::move(suffixes)});
  return option;
}

std::vector<const OutputFlags::Output*> OutputFlags::given() const {
  std::vector<const Output*> found;
  for (const auto& output : outputs_) {
    if (output.option->count() > 0) found.push_back(&output);
  }
  return found;
}

void OutputFlags::check() const {
  for (const Output* output : given()) {
    if (output->path->empty()) throw InvalidArgument(output->name(), "needs the name of a file");
    if (!output->suffixes.empty()) {
      require_suffix(output->name(), *output->path, output->suffixes);
    }
  }
  check_distinct();
  for (const Output* output : given()) require_writable(*output->path);
}

void OutputFlags::check_distinct() const {
  std::map<std::string, const Output*> by_target;
  for (const Output* output : given()) {
    if (!holds_one_result(*output->path)) continue;
    const auto [other, fresh] = by_target.emplace(output_target(*output->path), output);
    if (fresh) continue;
    throw InvalidArgument(output->name(), fmt::format("names the same file as {}: '{}'",
                                                      other->second->name(), *output->path));
  }
}

}  // namespace isotherm::apps
