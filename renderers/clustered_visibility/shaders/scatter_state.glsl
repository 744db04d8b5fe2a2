// State of a clustering by scattered lights; ScatterState of scatter_clusters.cpp.

layout(std430, binding = 7) coherent buffer ScatterState {
  int moved;       // lights that changed their cluster in this iteration
  int is_settled;  // 1: none did, nothing is done any more
};
