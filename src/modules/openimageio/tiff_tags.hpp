#pragma once
/// Finds kinds of TIFF files that OpenImageIO misreads without an error.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

/// Returns the number that a tag of a TIFF or BigTIFF file's first directory has in place of an
/// offset (TIFF 6.0, section 2; at most 16 bits of it). Returns nothing if the tag is absent, or
/// the file damaged.
std::optional<std::uint32_t> short_of_tiff(std::string_view file, std::uint32_t tag);
