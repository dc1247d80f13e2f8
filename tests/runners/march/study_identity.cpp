#include "runners/march/study_identity.hpp"

#include <catch2/catch.hpp>
#include <thread>

using namespace ricochet;

TEST_CASE("arithmetic digest: twelve digits, the same from every thread") {
  CHECK(arithmetic_digest().size() == 12);
  std::string other;
  std::thread([&] { other = arithmetic_digest(); }).join();
  CHECK(other == arithmetic_digest());
}
