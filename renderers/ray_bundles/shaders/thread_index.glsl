// Number of a thread in a dispatch of one or two dimensions (`dispatch_items`).
layout(local_size_x = 64) in;

uint thread_index() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  return group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
