// The targets of a pass, as `pass.targets`: the one that a workgroup works on, and the first one, which has
// what is common to all.
#define TARGET pass.targets.at[gl_WorkGroupID.z]
#define FIRST pass.targets.at[0]
