// The eye that a workgroup works on, loaded into shared memory once, so that not every thread fetches its
// forty words.

shared EyeView group_eye;

// In uniform control flow only.
EyeView shareEye(EyeViews eyes, uint eye) {
    barrier();  // an earlier call may still be reading
    if (gl_LocalInvocationIndex == 0) { group_eye = eyes.at[eye]; }
    barrier();
    return group_eye;
}
