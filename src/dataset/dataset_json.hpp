#pragma once
/// The JSON texts of a data set's folder: its identity, and its lists of files.

#include "io/json/reader.hpp"

#include <microtrace/dataset.hpp>
#include <microtrace/error.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace microtrace {

[[nodiscard]] std::string text_of(const DatasetIdentity& identity);
[[nodiscard]] DatasetIdentity identity_of(const io::JsonReader& root);

void append_file(std::string& text, const DatasetFile& file);
[[nodiscard]] DatasetFile read_file_entry(const io::JsonReader& json);

/// Returns read(root) for a JSON text that this program has written. Throws Error (io) if the text
/// is not as it was written.
template <class Read>
auto read_own(std::string_view text, const std::filesystem::path& path, const Read& read) {
  try {
    const io::JsonDocument document(text, path.string());
    return read(io::JsonReader(document));
  } catch (const Error& error) {
    Diagnostic damage = error.diagnostic();
    // Errors about memory name no file, but limits of JSON texts do.
    const bool exceeds_text = error.kind() == ErrorKind::limit && !damage.file.empty();
    if (error.kind() != ErrorKind::invalid_scene && !exceeds_text) throw;
    damage.message.insert(0, "is damaged: ");
    throw Error(ErrorKind::io, std::move(damage));
  }
}

}  // namespace microtrace
