// It lies with the simulated runtime, whose folder builds alone.
#pragma once

#include "xr/simulated/toml_guard.h"
