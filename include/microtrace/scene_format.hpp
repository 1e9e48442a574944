#pragma once
/// The formats of scene files.

namespace microtrace {

enum class SceneFormat { json, gltf };

}  // namespace microtrace
