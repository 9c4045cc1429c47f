# SPDX-License-Identifier: BSD-3-Clause
# cmake -D INPUT=page.html -D OUTPUT=page.cpp -D HEADER=page.hpp -D FUNCTION=Page -P EmbedText.cmake
# A C++ function that returns the text of a file, as one raw string: a megabyte compiles in a moment.
file(READ ${INPUT} text)
set(delimiter "masked_mapper")
string(FIND "${text}" ")${delimiter}\"" end)
if(NOT end EQUAL -1)
  message(FATAL_ERROR "${INPUT} holds the end of a raw string")
endif()
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: BSD-3-Clause
#include \"${HEADER}\"

namespace masked_mapper {

std::string_view ${FUNCTION}() {
  return R\"${delimiter}(${text})${delimiter}\";
}

}  // namespace masked_mapper
")
