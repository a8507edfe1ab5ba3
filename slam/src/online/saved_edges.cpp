#include "online/saved_edges.hpp"

#include <array>
#include <istream>
#include <iterator>
#include <limits>
#include <ostream>
#include <string>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/base/text_reader.hpp"

namespace isotherm::slam::detail {
namespace {

template <class Pose>
constexpr const char* header() {
  return Pose::kDim == 2 ? "isotherm-online/1 SE2" : "isotherm-online/1 SE3";
}

void write(std::ostream& out, const Pose2& pose) {
  out << ' ' << pose.translation().x() << ' ' << pose.translation().y() << ' ' << pose.angle();
}

void write(std::ostream& out, const Pose3& pose) {
  const auto& t = pose.translation();
  const auto& q = pose.rotation();
  out << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' ' << q.x() << ' ' << q.y() << ' '
      << q.z() << ' ' << q.w();
}

template <std::size_t kCount>
std::array<double, kCount> numbers(TextReader& line) {
  std::array<double, kCount> values;
  for (double& value : values) value = line.number("a number");
  return values;
}

void read(TextReader& line, Pose2& pose) {
  const auto v = numbers<3>(line);
  pose = Pose2(v[0], v[1], v[2]);
}

void read(TextReader& line, Pose3& pose) {
  const auto v = numbers<7>(line);
  pose = Pose3({v[0], v[1], v[2]}, Eigen::Quaterniond(v[6], v[3], v[4], v[5]));
}

template <class Pose>
typename EdgeLog<Pose>::Edge read_edge(TextReader& line) {
  typename EdgeLog<Pose>::Edge edge;
  edge.measured.link = static_cast<LinkKind>(line.unsigned_integer("a kind of link"));
  edge.from = line.unsigned_integer("a vertex id");
  edge.to = line.unsigned_integer("a vertex id");
  read(line, edge.measured.T_from_to);
  auto& information = edge.measured.information;
  for (int k = 0; k < information.size(); ++k) information(k) = line.number("information");
  return edge;
}

template <class Pose>
void read_line(TextReader& line, const EdgeReader<Pose>& reader) {
  const auto tag = line.word("POSE, FIX or EDGE");
  if (tag == "POSE") {
    const VertexId id = line.unsigned_integer("a vertex id");
    Pose pose;
    read(line, pose);
    reader.pose(id, pose);
  } else if (tag == "FIX") {
    reader.fixed(line.unsigned_integer("a vertex id"));
  } else if (tag == "EDGE") {
    reader.edge(read_edge<Pose>(line));
  } else {
    line.fail("expected POSE, FIX or EDGE");
  }
  line.expect_line_end();
}

}  // namespace

template <class Pose>
void write_edges(std::ostream& out, const EdgeLog<Pose>& log, Written& written) {
  const auto precision = out.precision(std::numeric_limits<double>::max_digits10);
  if (!std::exchange(written.header, true)) out << header<Pose>() << '\n';
  for (; written.poses < log.posed().size(); ++written.poses) {
    const VertexId id = log.posed()[written.poses];
    out << "POSE " << id;
    write(out, log.poses().at(id));
    out << '\n';
  }
  for (; written.fixed < log.fixed().size(); ++written.fixed) {
    out << "FIX " << log.fixed()[written.fixed] << '\n';
  }
  for (; written.edges < log.edges().size(); ++written.edges) {
    const auto& edge = log.edges()[written.edges];
    out << "EDGE " << static_cast<int>(edge.measured.link) << ' ' << edge.from << ' ' << edge.to;
    write(out, edge.measured.T_from_to);
    const auto& information = edge.measured.information;
    for (int k = 0; k < information.size(); ++k) out << ' ' << information(k);
    out << '\n';
  }
  out.precision(precision);
}

template <class Pose>
void read_edges(std::istream& in, const EdgeReader<Pose>& reader) {
  std::string whole(std::istreambuf_iterator<char>(in), {});
  whole.resize(whole.rfind('\n') + 1);  // what has no end was not written out
  TextReader text("saved state", whole);
  if (!text.next_line() || text.line() != header<Pose>()) {
    throw ParseError({"saved state", 1, 1}, "", std::string("expected '") + header<Pose>() + "'");
  }
  while (text.next_line()) read_line(text, reader);
}

template void write_edges(std::ostream&, const EdgeLog<Pose2>&, Written&);
template void write_edges(std::ostream&, const EdgeLog<Pose3>&, Written&);
template void read_edges(std::istream&, const EdgeReader<Pose2>&);
template void read_edges(std::istream&, const EdgeReader<Pose3>&);

}  // namespace isotherm::slam::detail
