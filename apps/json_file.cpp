#include "json_file.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/text_reader.hpp"

namespace isotherm::apps {
namespace {

// Goes through a text without making anything of it, and fails where it is not JSON or too
// deep; the parser proper can then fail no more.
class Checker : public nlohmann::json_sax<Json> {
 public:
  Checker(const std::string& path, const std::string& text) : path_(path), text_(text) {}

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool key(string_t&) override { return true; }
  bool start_object(std::size_t) override { return enter(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_object() override { return leave(); }
  bool end_array() override { return leave(); }

  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& error) override {
    constexpr int kOutOfRange = 406;
    const bool number = error.id == kOutOfRange;
    throw ParseError(where(position), token, number ? "is no finite number" : "is not valid JSON");
  }

 private:
  bool enter() {
    if (++depth_ <= kDeepestJson) return true;
    throw ParseError({path_, 0, 0}, "",
                     fmt::format("is nested deeper than {} levels", kDeepestJson));
  }
  bool leave() {
    --depth_;
    return true;
  }

  // `position` counts the bytes that were read.
  SourceLocation where(std::size_t position) const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(position, text_.size()));
    const auto line_begin = std::find(std::make_reverse_iterator(end), text_.rend(), '\n').base();
    return {path_, 1 + static_cast<std::uint64_t>(std::count(text_.begin(), end, '\n')),
            static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(1, end - line_begin))};
  }

  const std::string& path_;
  const std::string& text_;
  int depth_ = 0;
};

}  // namespace

Json read_json(const std::string& path) {
  const std::string text = read_whole(path);
  Checker checker(path, text);
  Json::sax_parse(text, &checker);
  return Json::parse(text);
}

}  // namespace isotherm::apps
