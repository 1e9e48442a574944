#pragma once
/// The source folder, from which tests read scenes and other cases.

#include <filesystem>

namespace microtrace::tests {

[[nodiscard]] std::filesystem::path source_folder();

}  // namespace microtrace::tests
