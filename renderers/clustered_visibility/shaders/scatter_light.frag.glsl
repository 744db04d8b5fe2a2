// Pass: additive blending sums the lights of a cluster.

layout(location = 0) flat in vec4 addend;
layout(location = 0) out vec4 sum;

void main() { sum = addend; }
