# Writes OUTPUT with the version and the git revision of SOURCE_DIR, only when it changes. Run at each build.
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12 OUTPUT_VARIABLE revision
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
if(NOT result EQUAL 0 OR revision STREQUAL "")
    set(revision unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
"#define REGATHER_VERSION \"${VERSION}\"
#define REGATHER_REVISION \"${revision}\"
" @ONLY)
