# SPDX-License-Identifier: MIT
#
# server_test.py SK SKC SOURCE: `sk serve` answers its own pages only, and limits what a program may take. Needs no browser.
import http.client
import json
import os
import re
import socket
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import playground

sk, skc, source = (os.path.realpath(path) for path in sys.argv[1:4])
program = "kernel void view(float time, out float r<>) { r = time; }"
own_type = {"Content-Type": "text/x-streamkernel"}

# Doubles its instances with each level: more than any machine has time for.
bomb = """template <int A, int B> struct Bomb { static constexpr int value = Bomb<A - 1, 2 * B>::value + Bomb<A - 1, 2 * B + 1>::value; };
template <int B> struct Bomb<0, B> { static constexpr int value = 1; };
kernel void f(out float r<>) { r = Bomb<30, 1>::value; }"""
# Valid, and more than two seconds of work.
slow = ("#define TERM(j) r += sin(neighbor(a, j, j / 2) * x) + pow(x, r);\n"
        "#define TEN(j) TERM(j) TERM(j + 1) TERM(j + 2) TERM(j + 3) TERM(j + 4) TERM(j + 5) TERM(j + 6) TERM(j + 7) TERM(j + 8) TERM(j + 9)\n"
        + "".join(f"kernel void k{i}(float x<>, float a[][], out float r<>) {{ r = x; TEN(0) TEN(10) TEN(20) TEN(30) }}\n" for i in range(400)))
# An expansion of 10^12 words.
macros = "#define A0 1 +\n" + "".join(f"#define A{i + 1} {f'A{i} ' * 10}\n" for i in range(12)) + "kernel void f(out float r<>) { r = A12 1; }"


def answer(address, method, path, body=None, **headers):
    """Status, headers and text of an answer. Headers are as given: Host, too."""
    connection = http.client.HTTPConnection(*address, timeout=300)
    try:
        connection.putrequest(method, path, skip_host="Host" in headers)
        for name, value in headers.items():
            connection.putheader(name.replace("_", "-"), value)
        if body is not None:
            connection.putheader("Content-Length", str(len(body)))
        connection.endheaders(body)
        response = connection.getresponse()
        return response.status, dict(response.getheaders()), response.read().decode()
    finally:
        connection.close()


def compiled(address, text):
    status, _, body = answer(address, "POST", "/compile", text.encode(), **{"Content-Type": own_type["Content-Type"]})
    assert status == 200, f"{status}: {body}"
    return json.loads(body)


def errors(address, text):
    answered = compiled(address, text)
    assert "module" not in answered, f"compiled: {text[:200]}"
    return [message for message in answered["messages"] if message["severity"] == "error"]


def check_borders(address):
    host, port = address
    status, headers, page = answer(address, "GET", "/")
    assert status == 200 and "<title>" in page
    nonce = re.search(r"'nonce-(\w{32})'", headers["Content-Security-Policy"])[1]
    assert f'nonce="{nonce}"' in page and "@NONCE@" not in page
    assert nonce not in answer(address, "GET", "/")[2], "the word of scripts is the same twice"
    assert answer(address, "GET", "/", Host=f"localhost:{port}")[0] == 200
    for wrong in ("evil.example", f"evil.example:{port}", host, f"{host}:{port + 1}", f"{host}:{port}.evil.example", ""):
        assert answer(address, "GET", "/", Host=wrong)[0] == 403, wrong
    assert answer(address, "GET", "/start", Origin=f"http://{host}:{port}")[0] == 200
    for wrong in ("http://evil.example", "null", f"https://{host}:{port}", f"http://{host}:{port}.evil.example", f"http://{host}"):
        status, headers, _ = answer(address, "GET", "/start", Origin=wrong)
        assert status == 403 and "Access-Control-Allow-Origin" not in headers, wrong
        assert answer(address, "POST", "/compile", program.encode(), Origin=wrong, **own_type)[0] == 403
    # what a form or a simple request of another page could send
    for simple in ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data"):
        assert answer(address, "POST", "/compile", program.encode(), **{"Content-Type": simple})[0] in (400, 415), simple
    for path in ("/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/programs/../index.html", "/nothing", "//etc/passwd"):
        status, _, body = answer(address, "GET", path)
        assert status in (400, 404) and "root:" not in body, f"{path}: {status}"
    assert answer(address, "PUT", "/style.css", b"")[0] in (400, 404)
    # other machines reach nothing
    with open("/proc/net/tcp") as sockets:
        bound = [line.split()[1] for line in sockets if line.split()[1].endswith(f":{port:04X}") and line.split()[3] == "0A"]
    assert bound == [f"0100007F:{port:04X}"], bound


def check_sizes(address):
    status, _, body = answer(address, "POST", "/compile", b"x" * 300_000, **own_type)
    assert status == 413 and "at most 256 kB" in body, f"{status}: {body}"
    assert errors(address, "")[0]["line"] == 0
    assert errors(address, "\0")
    assert errors(address, "kernel void f(out float r<>) { r = \xff; }")
    # a length that never comes must not keep the server from others
    with socket.create_connection(address) as lasting:
        lasting.sendall(f"POST /compile HTTP/1.1\r\nHost: {address[0]}:{address[1]}\r\nContent-Type: text/x-streamkernel\r\nContent-Length: 1000\r\n\r\n".encode())
        assert answer(address, "GET", "/")[0] == 200


def check_programs(address):
    answered = compiled(address, program)
    assert answered["messages"] == [] and "fileOf(" in answered["module"] and answered["glsl"].startswith("#version 300 es")
    assert answered["kernels"] == [{"name": "view", "kind": "kernel", "parameters": [
        {"name": "time", "role": "uniform", "type": "float", "rank": 0}, {"name": "r", "role": "output", "type": "float", "rank": 0}]}]
    [error] = errors(address, "kernel void f(out float r<>) {\n  r = y;\n}")
    assert (error["line"], error["column"]) == (2, 7) and "undeclared identifier 'y'" in error["text"]
    with tempfile.NamedTemporaryFile("w", suffix=".sk") as secret:
        secret.write("the secret;\n")
        secret.flush()
        for text in (f'#include "{secret.name}"', f"#include <{secret.name}>", f'#define F "{secret.name}"\n#include F', '#include "/etc/passwd"'):
            said = json.dumps(errors(address, f"{text}\n{program}"))
            assert "file not found" in said and "secret;" not in said and "root:" not in said, said
        asks = f'#if __has_include("{secret.name}")\n#error it is there\n#endif\n{program}'
        assert compiled(address, asks)["messages"] == [], "a program learns which files there are"
        embeds = f'const int a[] = {{\n#embed "{secret.name}"\n}};\n{program}'
        assert "module" not in compiled(address, embeds)


def check_limits(address):
    said = errors(address, bomb)[-1]["text"]
    assert "are instantiated more often" in said, said
    said = errors(address, slow)[-1]["text"]
    assert "stopped after 2 s of CPU time" in said or "MiB here" in said, said
    assert errors(address, macros)
    assert compiled(address, program)["messages"] == [], "the server is alive after that"


with tempfile.TemporaryDirectory() as temporary:
    os.environ["TMPDIR"] = temporary
    own = os.path.join(temporary, "own.sk")
    with open(own, "w") as file:
        file.write(program)
    with playground.served(sk, skc, own, "--seconds", "2", share=f"{source}/runtime/web") as address:
        start = json.loads(answer(address, "GET", "/start")[2])
        assert start["file"] == {"name": "own.sk", "text": program} and len(start["programs"]) >= 4 and not start["hasEditor"]
        check_borders(address)
        check_sizes(address)
        check_programs(address)
        check_limits(address)
        taken = subprocess.run([sk, "serve", "--port", str(address[1]), "--skc", skc], capture_output=True, text=True, env={**os.environ, "SK_SHARE": f"{source}/runtime/web"})
        assert taken.returncode == 1 and f"port {address[1]} of 127.0.0.1 is taken" in taken.stderr, taken.stderr
        for example in start["programs"]:
            answered = compiled(address, example["text"])
            assert answered["messages"] == [] and "module" in answered, f"{example['name']}: {answered['messages']}"
    assert os.listdir(temporary) == ["own.sk"], f"left behind: {os.listdir(temporary)}"

for words, message in (
    (["no.sk"], "there is no file 'no.sk'"), (["/"], "'/' is a folder"), (["--port", "65536"], "--port"), (["--port", "x"], "--port"),
    (["--skc", "/no/skc"], "there is no program '/no/skc'"),
):
    result = subprocess.run([sk, "serve", *words], capture_output=True, text=True, env={**os.environ, "SK_SHARE": f"{source}/runtime/web"})
    assert result.returncode == 1 and message in result.stderr, f"{words}: {result.stderr}"
print("sk serve answers its own pages only, and ends what takes too long")
