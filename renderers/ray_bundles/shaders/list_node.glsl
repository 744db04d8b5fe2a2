// A crossing; std430 mirror of `ListNode`.
struct ListNode {
  float depth_m;
  uint near_side;  // of a texel, that looks back along the line; the other one: bit 0 turned over
};

// Senders that are no surface.
const uint kAhead = 0xffffffffu;
const uint kBehind = 0xfffffffeu;
