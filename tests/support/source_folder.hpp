#pragma once
/// The source folder, for tests that read scenes and cases from it.

#include <filesystem>

namespace microtrace::tests {

[[nodiscard]] std::filesystem::path source_folder();

}  // namespace microtrace::tests
