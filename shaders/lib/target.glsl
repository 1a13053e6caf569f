// The targets of a pass, as `pass.targets`: the one that a workgroup works for, and the first, which has what belongs to all.
#define TARGET pass.targets.at[gl_WorkGroupID.z]
#define FIRST pass.targets.at[0]
