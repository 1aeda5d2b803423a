#!/bin/sh
# usage: imports.sh OBJDUMP PROGRAM: a program or DLL needs no DLLs but those of Windows and of this project.
set -eu
imported=$("$1" -p "$2" | sed -n 's/.*DLL Name: //p')
[ -n "$imported" ]
foreign=$(printf '%s\n' "$imported" | grep -viE '^(kernel32|msvcrt|ucrtbase|shell32|user32|advapi32|api-ms-win-.*|vox(_io|_sim)?)\.dll$' || true)
[ -z "$foreign" ] || { echo "$2 needs $foreign"; exit 1; }
