#include "folder.hpp"

#include <microtrace/error.hpp>
#include <microtrace/io.hpp>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>
#include <string>
#include <sys/wait.h>
#include <thread>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Runs a program of openimageio-tools and discards its output. Returns its exit status.
int run(const std::string& command) {
  const int status = std::system((command + " >/dev/null 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string output_of(const std::string& command, const fs::path& scratch) {
  EXPECT_EQ(std::system((command + " >" + scratch.string()).c_str()), 0);
  return read_bytes(scratch);
}

TEST(Module, LosslessFormatsEqualPpm) {
  const Folder folder;
  save_image(gradient(), folder / "a.ppm");
  for (const char* ending : {"png", "PNG", "tif", "bmp", "tga"}) {
    const fs::path path = folder / (std::string("a.") + ending);
    save_image(gradient(), path);
    EXPECT_EQ(run("idiff -fail 0 -warn 0 " + (folder / "a.ppm").string() + " " + path.string()), 0)
        << ending;
  }
}

TEST(Module, ExrStoresTheFloatsUnchanged) {
  const Folder folder;
  const Film film = gradient();
  save_image(film, folder / "a.exr");
  const std::string exr = (folder / "a.exr").string();
  EXPECT_THAT(
      output_of("oiiotool --info -v " + exr, folder / "info"),
      testing::AllOf(HasSubstr("3 channel, float openexr"), HasSubstr("R, G, B"),
                     testing::Not(HasSubstr("DateTime")), testing::Not(HasSubstr("Software"))));
  // An uncompressed float TIFF file contains its samples contiguously.
  ASSERT_EQ(
      run("oiiotool " + exr + " -d float --compression none -o " + (folder / "a.tif").string()), 0);
  std::string floats;
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    const auto row = std::as_bytes(film.row(y));
    floats.append(reinterpret_cast<const char*>(row.data()), row.size());
  }
  EXPECT_THAT(read_bytes(folder / "a.tif"), HasSubstr(floats));
}

TEST(Module, TwoRunsGiveTheSameBytes) {
  const Folder folder;
  const auto names = {"png", "exr", "tif", "jpg", "webp", "hdr"};
  // .hdr can't hold negative numbers.
  Film film = gradient();
  for (std::uint32_t y = 0; y < film.size().height; ++y) film.at(0, y).x = film.at(1, y).x = 0;
  for (const char* ending : names) save_image(film, folder / (std::string("a.") + ending));
  // Waits long enough to change a stored time.
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  for (const char* ending : names) {
    save_image(film, folder / (std::string("b.") + ending));
    EXPECT_EQ(read_bytes(folder / (std::string("a.") + ending)),
              read_bytes(folder / (std::string("b.") + ending)))
        << ending;
  }
}

TEST(Module, HdrIsRefusedForNumbersThatItCannotHold) {
  const Folder folder;
  for (const float number : {-0.5F, std::numeric_limits<float>::infinity()}) {
    Film film({.width = 5, .height = 4});
    save_image(film, folder / "right.hdr");
    film.at(3, 2).y = number;
    try {
      save_image(film, folder / "wrong.hdr");
      ADD_FAILURE() << number;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
    }
    save_image(film, folder / "right.exr");
  }
  EXPECT_EQ(folder.entries(), 2U);
}

TEST(Module, UnknownExtensionsAreUsageErrors) {
  const Folder folder;
  for (const char* name : {"a.xyz", "a.null", "a.pgm", "a.pbm", "a", "a."}) {
    try {
      save_image(gradient(), folder / name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_THAT(error.what(), HasSubstr(".ppm, .png or .exr")) << name;
    }
  }
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(Module, FailedWritesLeaveNothing) {
  const Folder folder;
  write_bytes(folder / "file", "x");
  EXPECT_THROW(save_image(gradient(), folder / "missing/a.png"), Error);
  EXPECT_THROW(save_image(gradient(), folder / "file/a.exr"), Error);
  fs::create_symlink("/dev/full", folder / "full.png");
  EXPECT_THROW(save_image(gradient(), folder / "full.png"), Error);
  // WebP allows at most 16383 pixels per side.
  EXPECT_THROW(save_image(Film({16384, 1}), folder / "wide.webp"), Error);
  EXPECT_EQ(folder.entries(), 2U);
}

TEST(Module, MissingModuleNamesThePackage) {
  const Folder folder;
  ::setenv("MICROTRACE_MODULE_PATH", (folder / "nowhere").c_str(), 1);
  try {
    save_image(gradient(), folder / "a.exr");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::unsupported);
    EXPECT_THAT(error.what(),
                testing::AllOf(HasSubstr("libopenexr-dev"), HasSubstr("microtrace_openexr"),
                               HasSubstr("nowhere")));
  }
  EXPECT_NO_THROW(save_image(gradient(), folder / "a.ppm"));
  ::unsetenv("MICROTRACE_MODULE_PATH");
}

TEST(Module, BrokenModuleIsReported) {
  const Folder folder;
  write_bytes(folder / "microtrace_openexr.so", "not a library");
  ::setenv("MICROTRACE_MODULE_PATH", (folder / "").c_str(), 1);
  try {
    save_image(gradient(), folder / "a.exr");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::unsupported);
    EXPECT_THAT(error.what(),
                HasSubstr("can't be written without the module microtrace_openexr.so: "));
  }
  ::unsetenv("MICROTRACE_MODULE_PATH");
}

}  // namespace
}  // namespace microtrace
