#include "base/memory_account.hpp"
#include "base/release.hpp"
#include "base/system/free_memory.hpp"
#include "base/system/processors.hpp"

#include <microtrace/error.hpp>
#include <microtrace/page_allocator.hpp>
#include <microtrace/render.hpp>
#include <microtrace/threads.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

using ::testing::HasSubstr;

TEST(MemoryBudget, RefusesBeforeExceedingTheLimit) {
  MemoryBudget budget(1000);
  budget.take(600, "a");
  budget.give_back(500);
  budget.take(900, "b");
  EXPECT_EQ(budget.peak(), 1000U);
  try {
    budget.take(1, "the pixels of images");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::limit);
    EXPECT_THAT(error.what(), HasSubstr("the pixels of images"));
    EXPECT_THAT(error.what(), HasSubstr("--memory-limit"));
  }
  budget.give_back(1000);
  EXPECT_THROW(budget.take(~std::uint64_t{0}, "c"), Error);
  EXPECT_NO_THROW(budget.take(1000, "d")) << "what was refused is not counted";
}

TEST(MemoryAccount, ReleasesItsMemory) {
  MemoryBudget budget(100);
  {
    MemoryAccount account(&budget);
    const MemoryScope scope(account);
    take_memory(60, "a");
    {
      const MemoryAccount work = temporary_memory(40, "b");
      EXPECT_THROW(take_memory(1, "c"), Error);
    }
    MemoryAccount other(std::move(account));
    EXPECT_THROW(take_memory(41, "d"), Error);
  }
  EXPECT_NO_THROW(budget.take(100, "e"));
}

TEST(MemoryAccount, CountsNothingWithoutABudget) {
  EXPECT_NO_THROW(take_memory(~std::uint64_t{0}, "a"));
  MemoryBudget budget(10);
  MemoryAccount account(&budget);
  const MemoryScope scope(account);
  MemoryAccount none(nullptr);
  {
    const MemoryScope inner(none);
    EXPECT_NO_THROW(take_memory(11, "b"));
  }
  EXPECT_THROW(take_memory(11, "c"), Error);
}

/// A temporary folder that stands for the root of the file system.
class SystemFiles : public ::testing::Test {
 protected:
  SystemFiles() {
    std::string name = (std::filesystem::temp_directory_path() / "microtrace-XXXXXX").string();
    root_ = mkdtemp(name.data());
  }
  ~SystemFiles() override { std::filesystem::remove_all(root_); }

  void write(const char* file, const char* text) const {
    std::filesystem::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }

  std::filesystem::path root_;
};

class FreeMemory : public SystemFiles {
 protected:
  FreeMemory() {
    write("proc/meminfo", "MemTotal: 9000 kB\nMemFree: 10 kB\nMemAvailable: 5000 kB\n");
  }
};

TEST_F(FreeMemory, EqualsTheAvailableMemoryOfTheSystem) {
  EXPECT_EQ(free_memory(root_), 5000U * 1024);
  write("proc/self/cgroup", "0::/\n");
  write("sys/fs/cgroup/memory.max", "max\n");
  EXPECT_EQ(free_memory(root_), 5000U * 1024);
}

TEST_F(FreeMemory, RespectsAllEnclosingGroups) {
  write("proc/self/cgroup", "0::/outer/inner\n");
  write("sys/fs/cgroup/outer/memory.max", "3000000\n");
  write("sys/fs/cgroup/outer/memory.current", "1000000\n");
  write("sys/fs/cgroup/outer/memory.stat", "anon 5\ninactive_file 400000\n");
  EXPECT_EQ(free_memory(root_), 2'400'000U);
  write("sys/fs/cgroup/outer/inner/memory.max", "700\n");
  write("sys/fs/cgroup/outer/inner/memory.current", "500\n");
  EXPECT_EQ(free_memory(root_), 200U);
  write("sys/fs/cgroup/outer/inner/memory.current", "900\n");
  EXPECT_EQ(free_memory(root_), 0U);
}

TEST_F(FreeMemory, RespectsGroupsOfVersion1) {
  write("proc/self/cgroup", "5:cpu,memory:/job\n1:cpuset:/\n");
  write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "800\n");
  write("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "300\n");
  EXPECT_EQ(free_memory(root_), 500U);
}

class ProcessorQuota : public SystemFiles {};

TEST_F(ProcessorQuota, IsAbsentWithoutALimit) {
  EXPECT_EQ(processor_quota(root_), std::nullopt);
  write("proc/self/cgroup", "0::/job\n");
  EXPECT_EQ(processor_quota(root_), std::nullopt);
  write("sys/fs/cgroup/job/cpu.max", "max 100000\n");
  EXPECT_EQ(processor_quota(root_), std::nullopt);
  write("proc/self/cgroup", "4:cpu,cpuacct:/job\n");
  write("sys/fs/cgroup/cpu/job/cpu.cfs_quota_us", "-1\n");
  write("sys/fs/cgroup/cpu/job/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(processor_quota(root_), std::nullopt);
}

TEST_F(ProcessorQuota, IsTheSmallestOfTheGroupsRoundedUp) {
  write("proc/self/cgroup", "0::/outer/inner\n");
  write("sys/fs/cgroup/cpu.max", "800000 100000\n");
  EXPECT_EQ(processor_quota(root_), 8U);
  write("sys/fs/cgroup/outer/cpu.max", "150000 100000\n");
  EXPECT_EQ(processor_quota(root_), 2U);
  write("sys/fs/cgroup/outer/inner/cpu.max", "1000 100000\n");
  EXPECT_EQ(processor_quota(root_), 1U);
  write("sys/fs/cgroup/outer/inner/cpu.max", "9000000000000 1000\n");
  EXPECT_EQ(processor_quota(root_), 2U);
}

TEST_F(ProcessorQuota, RespectsGroupsOfVersion1) {
  write("proc/self/cgroup", "5:cpu,cpuacct:/job\n1:cpuset:/\n");
  write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "400000\n");  // a container sees its group here
  write("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(processor_quota(root_), 4U);
  write("sys/fs/cgroup/cpu/job/cpu.cfs_quota_us", "50000\n");
  EXPECT_EQ(processor_quota(root_), 4U) << "a quota without its period";
  write("sys/fs/cgroup/cpu/job/cpu.cfs_period_us", "20000\n");
  EXPECT_EQ(processor_quota(root_), 3U);
}

TEST(DefaultThreads, IsAtMostTheQuota) {
  EXPECT_GE(default_threads(), 1U);
  if (const auto quota = processor_quota()) {
    EXPECT_LE(default_threads(), *quota);
  }
}

/// Returns a ball with `count` materials and `count` textures that all share one image.
Scene textured(std::size_t count) {
  Scene scene;
  const Image image{
      .width = 256, .height = 256, .channels = 1, .samples = std::vector<std::uint8_t>(65536)};
  scene.images.push_back(std::make_shared<const Image>(image));
  for (std::uint32_t i = 0; i < count; ++i) {
    scene.textures.push_back({.image = 0});
    Material material;
    material.base_color_texture = TextureUse{.texture = i};
    scene.materials.push_back(material);
    scene.objects.push_back({.name = "ball", .shape = Sphere{}, .material = i});
  }
  return scene;
}

TEST(RenderMemory, TexturesOfOneImageShareItsMipMaps) {
  const Camera camera = PerspectiveCamera{};
  const auto peak = [&](std::size_t textures) {
    MemoryBudget budget(std::uint64_t{1} << 40U);
    RenderOptions options;
    options.memory = &budget;
    (void)render(textured(textures), camera, {.width = 1, .height = 1}, options);
    const std::uint64_t result = budget.peak();
    EXPECT_NO_THROW(budget.take(budget.limit(), "all")) << "all is given back";
    return result;
  };
  constexpr std::uint64_t mip_maps = 65536 / 3 * 8;
  EXPECT_GE(peak(1), mip_maps);
  EXPECT_LT(peak(8), 2 * mip_maps);
}

TEST(RenderMemory, IsRefusedBeforeItIsTaken) {
  MemoryBudget budget(1'000'000);
  RenderOptions options;
  options.memory = &budget;
  const Scene scene = textured(1);
  EXPECT_NO_THROW((void)render(scene, PerspectiveCamera{}, {.width = 9, .height = 9}, options));
  EXPECT_THROW((void)render(scene, PerspectiveCamera{}, {.width = 65535, .height = 65535}, options),
               Error);
}

#ifdef __linux__
TEST(Release, DiscardsPagesWhoseElementsAreAllUsed) {
  constexpr std::size_t kPage = kHugePage / sizeof(std::uint32_t);
  PageVector<std::uint32_t> numbers(3 * kPage, 1);
  Release<std::uint32_t> release(numbers);
  const auto discarded = [&] {
    std::string pages;
    for (std::size_t page = 0; page < 3; ++page) pages += numbers[page * kPage] == 0 ? "x" : "-";
    return pages;
  };
  release(kPage + 5, 2 * kPage - 10);  // leaves 5 elements in each of the last two pages
  EXPECT_EQ(discarded(), "---");
  release(kPage, 5);
  EXPECT_EQ(discarded(), "-x-");
  release(0, kPage);
  release(3 * kPage - 5, 5);
  EXPECT_EQ(discarded(), "xxx");
}
#endif

}  // namespace
}  // namespace microtrace
