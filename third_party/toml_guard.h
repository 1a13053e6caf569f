// It lies with the simulated runtime, whose folder builds alone.
#pragma once

#include "xr/simulated/files/toml_guard.h"
