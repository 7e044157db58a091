# How our own sources are compiled, and how a room is declared. Who links a room gets C++20 and include paths, no flag.
add_library(slabhull_flags INTERFACE)
# Same bytes from the same input: no contraction to fused multiply-add behind our back.
target_compile_options(slabhull_flags INTERFACE -ffp-contract=off)
# Nobody asks errno about square roots; compilers may then take several at once.
target_compile_options(slabhull_flags INTERFACE -fno-math-errno)
target_compile_options(slabhull_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # A false alarm in unity builds: it takes every file but the one compiled for a header.
    target_compile_options(slabhull_flags INTERFACE $<$<BOOL:${SLABHULL_UNITY}>:-Wno-subobject-linkage>)
    if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
        target_compile_options(slabhull_flags INTERFACE -Wno-restrict) # gcc bug 105651: false alarms on std::string +
    endif()
endif()
if(SLABHULL_WERROR)
    target_compile_options(slabhull_flags INTERFACE -Werror)
endif()
if(SLABHULL_SANITIZE)
    set(sanitizers ${SLABHULL_SANITIZE})
    if(NOT sanitizers STREQUAL "thread")
        set(sanitizers address,undefined)
    endif()
    target_compile_options(slabhull_flags INTERFACE -fsanitize=${sanitizers} -fno-sanitize-recover=all
        -fno-omit-frame-pointer)
    # At fixed addresses, programs start in half the time: they have two million places to relocate.
    target_link_options(slabhull_flags INTERFACE -fsanitize=${sanitizers} $<$<LINK_LANGUAGE:CXX>:-no-pie>)
    if(NOT SLABHULL_SANITIZE STREQUAL "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        target_link_options(slabhull_flags INTERFACE $<$<LINK_LANGUAGE:CXX>:-static-libasan>) # for core/sanitizer_fork.cpp
    endif()
endif()
if(SLABHULL_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
        message(FATAL_ERROR "SLABHULL_FUZZ needs Clang, for libFuzzer: cmake --preset fuzz")
    endif()
    set(fuzz_sanitizers address,undefined,float-cast-overflow)
    target_compile_options(slabhull_flags INTERFACE -fsanitize=fuzzer-no-link,${fuzz_sanitizers}
        -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(slabhull_flags INTERFACE -fsanitize=${fuzz_sanitizers})
endif()

# slabhull_room(<name> [NOT_INSTALLED] [NO_HOT_LOOPS] SOURCES <files> [USES <rooms>] [LINKS <private libraries>])
# A room is a library Slabhull::<name>, static or by BUILD_SHARED_LIBS shared, with public headers under include/slabhull/<name>/.
# What it LINKS stays inside its .cpp files and out of its headers. Private headers are included by their path from the
# top: "geometry/meshing/cap_spacing.h". A room with NO_HOT_LOOPS is optimised less, for a quicker build.
function(slabhull_room name)
    cmake_parse_arguments(room "NOT_INSTALLED;NO_HOT_LOOPS" "" "SOURCES;USES;LINKS" ${ARGN})
    set(target slabhull_${name})
    set(kind STATIC)
    if(BUILD_SHARED_LIBS AND NOT room_NOT_INSTALLED)
        set(kind SHARED)
    endif()
    add_library(${target} ${kind} ${room_SOURCES})
    add_library(Slabhull::${name} ALIAS ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
        VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
        UNITY_BUILD ${SLABHULL_UNITY} UNITY_BUILD_BATCH_SIZE 16)
    target_include_directories(${target} PUBLIC
        $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
    target_compile_features(${target} PUBLIC cxx_std_20)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:slabhull_flags>)
    foreach(used IN LISTS room_USES)
        target_link_libraries(${target} PUBLIC slabhull_${used})
    endforeach()
    target_link_libraries(${target} PRIVATE ${room_LINKS})
    if(room_NO_HOT_LOOPS)
        target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
    endif()
    if(NOT room_NOT_INSTALLED)
        install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
        install(TARGETS ${target} EXPORT SlabhullTargets ARCHIVE COMPONENT dev
            LIBRARY COMPONENT lib NAMELINK_COMPONENT dev)
    endif()
endfunction()
