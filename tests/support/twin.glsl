// The main() of every twin: one thread per input. TWIN_INPUT, TWIN_OUTPUT and TWIN_FUNCTION are defined before.
layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer Inputs { TWIN_INPUT inputs[]; };
layout(scalar, set = 0, binding = 1) writeonly buffer Outputs { TWIN_OUTPUT outputs[]; };
layout(push_constant, scalar) uniform Push { uint count; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) outputs[i] = TWIN_FUNCTION(inputs[i]);
}
