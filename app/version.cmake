# Writes FILE with the version as the program states it: "0.1.0", and what `git describe` says where the
# source is a checkout that is not tagged so. Only when that changed, so that nothing is compiled for nothing.
execute_process(COMMAND git -C ${SOURCE} describe --tags --always --dirty OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(version "${VERSION}")
if(described AND NOT described STREQUAL "v${VERSION}")
    string(APPEND version " (${described})")
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT [[
#include "app/terminal/version.h"

const char* const binosplat::kVersion = "@version@";
]] @ONLY)
