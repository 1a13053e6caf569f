// The eye that a workgroup works for, brought to shared memory once, so that its forty words are not fetched by every thread.

shared EyeView group_eye;

// In uniform control flow only.
EyeView shareEye(EyeViews eyes, uint eye) {
    barrier();  // an earlier call may still be reading
    if (gl_LocalInvocationIndex == 0) { group_eye = eyes.at[eye]; }
    barrier();
    return group_eye;
}
