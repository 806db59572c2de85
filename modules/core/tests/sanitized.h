#pragma once

namespace gnomon {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool IS_SANITIZED = true;
#else
inline constexpr bool IS_SANITIZED = false;
#endif

/// Returns how many cases of its kind a test tries: with sanitizers, under which code takes 20
/// times as long, a sixth of them, but at least one.
constexpr int limit_rounds(int p_count) {
	return IS_SANITIZED ? (p_count + 5) / 6 : p_count;
}

} // namespace gnomon
