#include "distributed/support/comm.hpp"

#include <exception>
#include <new>
#include <string>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

enum class Kind : int { none, argument, parse, file, numerical, cancelled, memory, other };

/// An error as it travels: what it was made of.
struct Report {
  Kind kind = Kind::none;
  std::string subject;  // option, path or stage
  std::string problem;
  std::string token;
  std::uint64_t line = 0;
  std::uint64_t column = 0;
};

/// What follows the subject in a message.
std::string behind(const std::string& subject, const std::string& message) {
  const std::string start = subject + ": ";
  return message.starts_with(start) ? message.substr(start.size()) : message;
}

Report report_of(const ParseError& error) {
  Report report{Kind::parse, error.path(), "", error.token(), error.line(), error.column()};
  const SourceLocation where{error.path(), error.line(), error.column()};
  report.problem = behind(to_string(where), error.what());
  const auto got = report.problem.rfind(" (got '");
  if (!error.token().empty() && got != std::string::npos) report.problem.resize(got);
  return report;
}

Report run(const std::function<void()>& work) {
  try {
    work();
  } catch (const InvalidArgument& error) {
    return {Kind::argument, error.option(), behind(error.option(), error.what())};
  } catch (const ParseError& error) {
    return report_of(error);
  } catch (const FileError& error) {
    return {Kind::file, error.path(), behind(error.path(), error.what())};
  } catch (const NumericalError& error) {
    return {Kind::numerical, error.stage(), behind(error.stage(), error.what())};
  } catch (const Cancelled&) {
    return {Kind::cancelled};
  } catch (const std::bad_alloc&) {
    return {Kind::memory};
  } catch (const std::exception& error) {
    return {Kind::other, "", error.what()};
  }
  return {};
}

void broadcast(const Comm& comm, int root, std::string& text) {
  auto size = static_cast<std::int64_t>(text.size());
  MPI_Bcast(&size, 1, MPI_INT64_T, root, comm.handle);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), static_cast<int>(size), MPI_CHAR, root, comm.handle);
}

[[noreturn]] void raise(const Report& report) {
  switch (report.kind) {
    case Kind::argument:
      throw InvalidArgument(report.subject, report.problem);
    case Kind::parse:
      throw ParseError({report.subject, report.line, report.column}, report.token, report.problem);
    case Kind::file:
      throw FileError(report.subject, report.problem);
    case Kind::numerical:
      throw NumericalError(report.subject, report.problem);
    case Kind::cancelled:
      throw Cancelled();
    case Kind::memory:
      throw std::bad_alloc();
    case Kind::none:
    case Kind::other:
      break;
  }
  throw Error(report.problem);
}

}  // namespace

void together(const Comm& comm, const std::function<void()>& work) {
  Report report = run(work);
  const int first = least(comm, report.kind == Kind::none ? comm.size : comm.rank);
  if (first == comm.size) return;
  MPI_Bcast(&report.kind, sizeof(report.kind), MPI_BYTE, first, comm.handle);
  for (std::string* text : {&report.subject, &report.problem, &report.token}) {
    broadcast(comm, first, *text);
  }
  MPI_Bcast(&report.line, 1, MPI_UINT64_T, first, comm.handle);
  MPI_Bcast(&report.column, 1, MPI_UINT64_T, first, comm.handle);
  raise(report);
}

Blocks::Blocks(const Comm& comm, std::int64_t total) {
  starts_.clear();
  for (int rank = 0; rank <= comm.size; ++rank) {
    const auto share = total / comm.size, rest = total % comm.size;
    starts_.push_back(share * rank + std::min<std::int64_t>(rank, rest));
  }
}

Blocks Blocks::of_sizes(const Comm& comm, std::int64_t mine) {
  Blocks blocks;
  std::int64_t next = 0;
  for (const auto size : gather_all(comm, mine)) blocks.starts_.push_back(next += size);
  return blocks;
}

}  // namespace isotherm::spectral::distributed::detail
