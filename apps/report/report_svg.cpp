#include "report/report_svg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "report/xml_text.hpp"

namespace isotherm::apps {
namespace {

constexpr double kWidth = 800.0;
constexpr double kHeight = 600.0;
constexpr double kMargin = 20.0;
constexpr double kMapHeight = kHeight - 60.0;  // the legend is below

struct Point {
  double x = std::numeric_limits<double>::quiet_NaN();
  double y = std::numeric_limits<double>::quiet_NaN();

  bool known() const { return std::isfinite(x) && std::isfinite(y); }
};

// One kind of line. Colours are those of Okabe and Ito, told apart by people who do not
// see red or green; dashes and widths tell them apart in print.
struct Layer {
  std::string label;
  const char* colour;
  double width;
  const char* dashes;  // or empty
  std::string path;    // SVG path data
  std::int64_t lines = 0;
};

// The plane as it is; space seen from 30 degrees above, turned by 30 degrees.
Point project(const float* position, int dimension) {
  if (dimension < 3) return {position[0], dimension > 1 ? position[1] : 0.0};
  constexpr double kYaw = std::numbers::pi / 6.0;
  constexpr double kPitch = std::numbers::pi / 6.0;
  const double right = std::cos(kYaw) * position[0] + std::sin(kYaw) * position[1];
  const double away = -std::sin(kYaw) * position[0] + std::cos(kYaw) * position[1];
  return {right, std::sin(kPitch) * away + std::cos(kPitch) * position[2]};
}

std::vector<Point> project(const std::vector<float>& positions, int dimension) {
  std::vector<Point> points;
  for (std::size_t k = 0; k + dimension <= positions.size(); k += dimension) {
    points.push_back(project(&positions[k], dimension));
  }
  return points;
}

// Maps what is drawn into the middle of the picture, y upwards, without distortion.
struct Frame {
  Point centre{0.0, 0.0};
  double scale = 1.0;  // picture units a unit of the layout

  explicit Frame(const std::vector<Point>& points) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Point least{kInfinity, kInfinity};
    Point most{-kInfinity, -kInfinity};
    for (const auto& point : points) {
      if (!point.known()) continue;
      least = {std::min(least.x, point.x), std::min(least.y, point.y)};
      most = {std::max(most.x, point.x), std::max(most.y, point.y)};
    }
    if (!least.known()) return;
    centre = {(least.x + most.x) / 2.0, (least.y + most.y) / 2.0};
    const double fit_x = (kWidth - 2.0 * kMargin) / (most.x - least.x);
    const double fit_y = (kMapHeight - 2.0 * kMargin) / (most.y - least.y);
    if (std::isfinite(std::min(fit_x, fit_y))) scale = std::min(fit_x, fit_y);
  }

  Point operator()(const Point& point) const {
    return {kWidth / 2.0 + (point.x - centre.x) * scale,
            kMapHeight / 2.0 - (point.y - centre.y) * scale};
  }
};

void add_line(Layer& layer, const Frame& frame, const Point& from, const Point& to) {
  if (!from.known() || !to.known()) return;
  const Point a = frame(from);
  const Point b = frame(to);
  layer.path += fmt::format("M{:.2f} {:.2f}L{:.2f} {:.2f}", a.x, a.y, b.x, b.y);
  ++layer.lines;
}

std::vector<Layer> layers_of(const Report& report, const std::vector<Point>& points,
                             const std::vector<Point>& truth, const Frame& frame) {
  const auto& nouns = report.nouns;
  // In drawing order; verdicts 0, 1 and 2 are layers 2, 3 and 4.
  std::vector<Layer> layers = {{nouns.trusted, "#999999", 1.0, "", {}},
                               {"ground truth", "#009e73", 1.0, "5 3", {}},
                               {"kept " + nouns.edges, "#0072b2", 1.2, "", {}},
                               {"pruned " + nouns.edges, "#d55e00", 0.8, "", {}},
                               {"ambiguous " + nouns.edges, "#cc79a7", 1.0, "2 2", {}}};
  for (std::size_t k = 0; k + 1 < report.trusted.size(); k += 2) {
    add_line(layers[0], frame, points[report.trusted[k]], points[report.trusted[k + 1]]);
  }
  for (std::size_t k = 1; k < truth.size(); ++k) {
    add_line(layers[1], frame, truth[k - 1], truth[k]);
  }
  const auto& all = report.candidates;
  for (std::size_t k = 0; k < all.size(); ++k) {
    add_line(layers[2 + all.verdict[k]], frame, points[all.from[k]], points[all.to[k]]);
  }
  std::erase_if(layers, [](const Layer& layer) { return layer.lines == 0; });
  return layers;
}

std::string stroke(const Layer& layer) {
  const std::string dashes =
      *layer.dashes == '\0' ? "" : fmt::format(" stroke-dasharray=\"{}\"", layer.dashes);
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}", layer.colour, layer.width,
                     dashes);
}

std::string legend(const std::vector<Layer>& layers) {
  std::string text;
  double x = kMargin;
  for (const auto& layer : layers) {
    const std::string label = fmt::format("{} ({})", layer.label, layer.lines);
    text +=
        fmt::format("<path d=\"M{0:.0f} {1}h24\" {2}/>\n<text x=\"{3:.0f}\" y=\"{4}\">{5}</text>\n",
                    x, kHeight - 16.0, stroke(layer), x + 30.0, kHeight - 12.0, xml_text(label));
    x += 44.0 + 6.5 * static_cast<double>(label.size());
  }
  return text;
}

// 1, 2 or 5 times a power of ten, at most `limit`.
double round_length(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= limit) return digit * power;
  }
  return power;
}

std::string scale_bar(const Report& report, const Frame& frame) {
  if (report.unit.empty()) return {};
  const double length = round_length(kWidth / 5.0 / frame.scale);
  return fmt::format(
      "<path d=\"M{0} {1}v4h{2:.2f}v-4\" fill=\"none\" stroke=\"#000000\"/>\n"
      "<text x=\"{3:.2f}\" y=\"{4}\">{5} {6}</text>\n",
      kMargin, kHeight - 44.0, length * frame.scale, kMargin + length * frame.scale + 6.0,
      kHeight - 38.0, length, report.unit);
}

}  // namespace

std::string report_svg(const Report& report) {
  const auto& layout = report.layouts.back();
  const auto points = project(layout.positions, report.dimension);
  const auto truth = project(layout.truth, report.dimension);
  auto drawn = points;
  drawn.insert(drawn.end(), truth.begin(), truth.end());
  const Frame frame(drawn);
  const auto layers = layers_of(report, points, truth, frame);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\">\n<title>{2}</title>\n"
      "<desc>{3}</desc>\n<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      kWidth, kHeight, xml_text(report.title), xml_text(layout.label));
  for (const auto& layer : layers) {
    svg += fmt::format("<path {} d=\"{}\"/>\n", stroke(layer), layer.path);
  }
  return svg + legend(layers) + scale_bar(report, frame) + "</svg>\n";
}

}  // namespace isotherm::apps
