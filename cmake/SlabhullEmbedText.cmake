# What SlabhullEmbed.cmake runs when a text has changed: writes it as raw string literals. A line end parts the files.
string(REPLACE "," ";" FILES "${FILES}")
set(literals)
foreach(file IN LISTS FILES)
    file(READ ${file} content)
    string(APPEND literals "R\"_slabhull_(${content}\n)_slabhull_\"\n")
endforeach()
file(WRITE ${OUT} "#include <string_view>\nnamespace slabhull::embedded {\nextern const std::string_view ${NAME};\n"
    "const std::string_view ${NAME}{${literals}};\n}\n")
