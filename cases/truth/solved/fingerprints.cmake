# Writes a header with two hashes: of the sources that make the truth 'reference', and of those that make the truth
# 'events', each with the compiler and its flags. What a solution was made by is part of its name in the cache, so that
# no change of these sources can leave an older solution in use; a build of the same sources by the same compiler has the
# same hashes wherever it lies.
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

namespace rigor {

inline constexpr const char* kReferenceMadeBy = \"${reference}\";
inline constexpr const char* kEventsMadeBy = \"${events}\";

}  // namespace rigor
")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "${text}" @ONLY)  # leaves a file alone that says so already
