# Writes a header with the commit of the sources; leaves an unchanged file alone.
# cmake -DROOT=... -DOUTPUT=... -P commit.cmake
set(commit "")
execute_process(COMMAND git -C ${ROOT} describe --always --dirty --abbrev=10 OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "")
endif()
set(text "// Made by commit.cmake.\n#define RIGOR_COMMIT \"${commit}\"\n")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "${text}" @ONLY)  # leaves an unchanged file alone
