#include <iostream>
#include <memory>

#include <gtest/gtest.h>

#include "spectral/distributed/ranks.hpp"

namespace isotherm_test {
namespace {

const distributed::Session* the_session = nullptr;

/// Ranks but the first say what went wrong only.
class Failures : public testing::EmptyTestEventListener {
 public:
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (!result.failed()) return;
    std::cerr << "rank " << session().rank() << ": " << result.file_name() << ':'
              << result.line_number() << ": " << result.message() << std::endl;
  }
};

}  // namespace

const distributed::Session& session() { return *the_session; }

}  // namespace isotherm_test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const isotherm_test::distributed::Session session;
  isotherm_test::the_session = &session;
  if (session.rank() > 0) {
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new isotherm_test::Failures);
  }
  const int code = RUN_ALL_TESTS();
  return session.agree_on_end(code, "tests failed",
                              [](std::string_view text) { std::cerr << text << std::endl; });
}
