// judges_test.py lets NumPy read such files.
#include "dataset/annotations/npz.hpp"

#include <microtrace/error.hpp>

#include <vector>

#include <gtest/gtest.h>

namespace microtrace::dataset::tests {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(Npz, ArraysThatDoNotFitAreRefused) {
  const Bytes bytes(6);
  const auto with = [&](std::string name, std::vector<std::size_t> shape) {
    return NpzArray{.name = std::move(name), .shape = std::move(shape), .values = std::span(bytes)};
  };
  EXPECT_NO_THROW(static_cast<void>(npz(std::vector{with("a", {2, 3}), with("b", {6})})));
  for (const auto& arrays :
       {std::vector{with("a", {2, 2})}, std::vector{with("", {6})}, std::vector{with("a", {})},
        std::vector{with("a", {6}), with("a", {6})},
        std::vector{with("a", {std::size_t{1} << 63, 2, 0})},
        std::vector{with(std::string(70000, 'a'), {6})}})
    EXPECT_THROW(static_cast<void>(npz(arrays)), Error);
}

TEST(Npz, EmptyArchiveIsItsEndRecord) {
  EXPECT_EQ(npz({}).size(), 22U);
}

}  // namespace
}  // namespace microtrace::dataset::tests
