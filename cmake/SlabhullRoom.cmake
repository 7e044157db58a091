# What every target of ours shares, and how a room is declared.
add_library(slabhull_settings INTERFACE)
add_library(Slabhull::settings ALIAS slabhull_settings)
target_compile_features(slabhull_settings INTERFACE cxx_std_20)
# Same bytes from the same input: no contraction to fused multiply-add behind our back.
target_compile_options(slabhull_settings INTERFACE -ffp-contract=off)

add_library(slabhull_warnings INTERFACE)
target_compile_options(slabhull_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(slabhull_warnings INTERFACE -Wno-restrict) # gcc bug 105651: false alarms on std::string +
endif()
if(SLABHULL_WERROR)
    target_compile_options(slabhull_warnings INTERFACE -Werror)
endif()
if(SLABHULL_SANITIZE)
    target_compile_options(slabhull_settings INTERFACE -fsanitize=address,undefined
        -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(slabhull_settings INTERFACE -fsanitize=address,undefined)
endif()
if(SLABHULL_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
        message(FATAL_ERROR "SLABHULL_FUZZ needs Clang, for libFuzzer: cmake --preset fuzz")
    endif()
    set(fuzz_sanitizers address,undefined,float-cast-overflow)
    target_compile_options(slabhull_settings INTERFACE -fsanitize=fuzzer-no-link,${fuzz_sanitizers}
        -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(slabhull_settings INTERFACE -fsanitize=${fuzz_sanitizers})
endif()

# slabhull_room(<name> [NOT_INSTALLED] SOURCES <files> [USES <rooms>] [LINKS <private libraries>])
# A room is a static library Slabhull::<name> with public headers under include/slabhull/<name>/.
# What it LINKS stays inside its .cpp files and out of its headers. Private headers are included by their path from the
# top: "geometry/meshing/cap_spacing.h".
function(slabhull_room name)
    cmake_parse_arguments(room "NOT_INSTALLED" "" "SOURCES;USES;LINKS" ${ARGN})
    set(target slabhull_${name})
    add_library(${target} STATIC ${room_SOURCES})
    add_library(Slabhull::${name} ALIAS ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
    target_include_directories(${target} PUBLIC
        $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${target} PUBLIC slabhull_settings PRIVATE $<BUILD_INTERFACE:slabhull_warnings>)
    foreach(used IN LISTS room_USES)
        target_link_libraries(${target} PUBLIC slabhull_${used})
    endforeach()
    target_link_libraries(${target} PRIVATE ${room_LINKS})
    if(NOT room_NOT_INSTALLED)
        install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
        install(TARGETS ${target} EXPORT SlabhullTargets)
    endif()
endfunction()
