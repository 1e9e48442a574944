#pragma once
/// Where the sources are, for tests that read scenes and cases from there.

#include <filesystem>

namespace microtrace::tests {

[[nodiscard]] std::filesystem::path source_folder();

}  // namespace microtrace::tests
