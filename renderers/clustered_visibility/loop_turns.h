#pragma once

namespace renderers::clustered_visibility {

/// Turns of a thread's loops in one dispatch, together: Mesa's software drivers end them after
/// 65,535 without a word. Half of it, for the loops that nobody counts.
inline constexpr int kMostTurns = 30000;

}  // namespace renderers::clustered_visibility
