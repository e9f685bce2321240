import asyncio

import pytest

from bladegen.studio.guard import Guard, is_loopback

TOKEN = "secret-token"


async def application(scope, receive, send):
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.accept"})
        return
    body = b""
    while True:
        message = await receive()
        body += message.get("body", b"")
        if not message.get("more_body"):
            break
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": body})


def asked(guard, *, kind="http", query=b"", path="/", body=(b"",), **headers):
    """Send one request; return the messages of the answer."""
    scope = {
        "type": kind,
        "path": path,
        "query_string": query,
        "headers": [(k.replace("_", "-").encode(), v.encode()) for k, v in headers.items()],
    }
    if kind == "websocket":
        waiting = [{"type": "websocket.connect"}]
    else:
        waiting = [
            {"type": "http.request", "body": part, "more_body": i + 1 < len(body)}
            for i, part in enumerate(body)
        ]
    sent = []

    async def receive():
        return waiting.pop(0)

    async def send(message):
        sent.append(message)

    asyncio.run(guard(scope, receive, send))
    return sent


def status(guard, **request):
    return asked(guard, **request)[0]["status"]


@pytest.mark.parametrize("host", ["127.0.0.1:8642", "localhost", "[::1]:80"])
def test_loopback_needs_no_token(host):
    assert status(Guard(application, None, 100), host=host) == 200


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example:80", ""])
def test_names_that_others_own_do_not_reach_loopback(host):
    assert status(Guard(application, None, 100), host=host) == 403


def test_elsewhere_the_token_is_asked_for_once():
    guard = Guard(application, TOKEN, 100)
    assert status(guard, host="x") == 403
    assert status(guard, host="x", query=b"token=wrong") == 403
    first = asked(guard, host="x", query=b"blade=nrel5mw&token=secret-token&t=0,0", path="/")[0]
    headers = dict(first["headers"])
    assert first["status"] == 303
    assert headers[b"location"] == b"/?blade=nrel5mw&t=0%2C0"
    cookie = headers[b"set-cookie"].decode()
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    assert status(guard, host="x", cookie=cookie.split(";")[0]) == 200
    assert status(guard, host="x", cookie="bladegen_studio=wrong") == 403
    assert status(guard, host="x", cookie="bad\x00=;;=") == 403


def test_a_websocket_comes_from_a_page_of_the_same_place():
    for guard, extra in (
        (Guard(application, None, 100), {}),
        (Guard(application, TOKEN, 100), {"cookie": f"bladegen_studio={TOKEN}"}),
    ):
        own = {"host": "localhost:1", "origin": "http://localhost:1", **extra}
        assert asked(guard, kind="websocket", **own)[0]["type"] == "websocket.accept"
        other = asked(guard, kind="websocket", **{**own, "origin": "http://evil.example"})
        assert other[0]["type"] == "websocket.close"
    assert asked(Guard(application, TOKEN, 9), kind="websocket", host="x")[0]["type"] == (
        "websocket.close"
    )


def test_bodies_are_bounded_whether_their_length_is_said_or_not():
    guard, host = Guard(application, None, 10), {"host": "localhost"}
    assert asked(guard, body=(b"12345", b"67890"), **host)[1]["body"] == b"1234567890"
    assert status(guard, body=(b"12345", b"678901"), **host) == 413
    assert status(guard, content_length="11", **host) == 413
    assert status(guard, content_length="much", **host) == 413


def test_other_messages_pass():
    seen = []

    async def app(scope, receive, send):
        seen.append(scope["type"])

    asyncio.run(Guard(app, TOKEN, 1)({"type": "lifespan"}, None, None))
    assert seen == ["lifespan"]


def test_what_is_loopback():
    assert all(map(is_loopback, ("127.0.0.1", "::1", "localhost")))
    assert not any(map(is_loopback, ("0.0.0.0", "::", "192.168.0.1", "")))
