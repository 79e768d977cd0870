# Writes a header with two hashes: of the sources of the truth 'reference', and of those of the truth 'events', each
# with the compiler and its flags. The hashes are part of a solution's name in the cache, so an old solution is never
# used after a change of these sources. Builds of the same sources with the same compiler have the same hashes at any
# place.
# cmake -DROOT=... -DCOMPILER=... -DOUTPUT=... -P fingerprints.cmake
cmake_minimum_required(VERSION 3.25)

function(fingerprint out)
  set(all "${COMPILER}")
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ARGN})
  list(SORT files)
  foreach(file ${files})
    file(SHA256 ${ROOT}/${file} hash)
    string(APPEND all "\n${file} ${hash}")
  endforeach()
  string(SHA256 hash "${all}")
  set(${out} ${hash} PARENT_SCOPE)
endfunction()

fingerprint(reference ${ROOT}/cases/truth/solved/*.h ${ROOT}/cases/truth/solved/*.cpp ${ROOT}/core/scene/*.h ${ROOT}/core/scene/*.cpp)
fingerprint(events ${ROOT}/cases/truth/solved/*.h ${ROOT}/cases/truth/solved/*.cpp ${ROOT}/core/*.h ${ROOT}/core/*.cpp)

set(text "// Made by fingerprints.cmake.
#pragma once

namespace rigor::inline truth {

inline constexpr const char* kReferenceMadeBy = \"${reference}\";
inline constexpr const char* kEventsMadeBy = \"${events}\";

}  // namespace rigor::inline truth
")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "${text}" @ONLY)  # leaves an unchanged file alone
