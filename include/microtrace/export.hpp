#pragma once
/// Marks the symbols that the shared library exports. All other symbols are hidden.

#define MICROTRACE_EXPORT [[gnu::visibility("default")]]
#define MICROTRACE_HIDDEN [[gnu::visibility("hidden")]]  // for classes nested in an exported class
