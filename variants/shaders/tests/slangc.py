"""Runs the Slang compiler of the package slangpy with the arguments of slangc, which the package lacks."""

import ctypes
import importlib.util
import sys
from pathlib import Path

(package,) = importlib.util.find_spec("slangpy").submodule_search_locations
compiler = ctypes.CDLL(str(next(Path(package).glob("libslang-compiler.*"))))
compiler.spCreateSession.restype = compiler.spCreateCompileRequest.restype = ctypes.c_void_p
compiler.spGetDiagnosticOutput.restype = ctypes.c_char_p
session = ctypes.c_void_p(compiler.spCreateSession(None))
request = ctypes.c_void_p(compiler.spCreateCompileRequest(session))
# As slangc does, so that the compiler writes the file of -o.
compiler._Z28spSetCommandLineCompilerModePN5slang15ICompileRequestE(request)
arguments = [argument.encode() for argument in sys.argv[1:]]
failed = compiler.spProcessCommandLineArguments(request, (ctypes.c_char_p * len(arguments))(*arguments), len(arguments))
failed = failed or compiler.spCompile(request)
print((compiler.spGetDiagnosticOutput(request) or b"").decode(), end="", file=sys.stderr)
sys.exit(failed != 0)
