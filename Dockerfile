# Two images: `core` reads, perturbs and writes blades (1.1 GB); `full` has pictures, families,
# polars and the studio as well (3.1 GB).
#   docker build --target core -t bladegen:core .
#   docker build -t bladegen .
#   docker run --rm -v "$PWD:/data" bladegen build iea15mw -o out/

FROM debian:13-slim AS python
RUN apt-get update \
    && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
        libexpat1 libgl1 libx11-6 python3 python3-venv \
    && rm -rf /var/lib/apt/lists/* \
    && python3 -m venv /opt/bladegen
ENV PATH=/opt/bladegen/bin:$PATH \
    PIP_NO_CACHE_DIR=1 \
    PIP_DISABLE_PIP_VERSION_CHECK=1 \
    PYTHONDONTWRITEBYTECODE=1
WORKDIR /src
COPY pyproject.toml README.md LICENSE ./
COPY locks locks
COPY blades blades
COPY bladegen bladegen

FROM python AS core
RUN pip install --no-deps --requirement locks/core.txt && pip install --no-deps .
WORKDIR /data
ENTRYPOINT ["bladegen"]
CMD ["--help"]

FROM python AS full
RUN apt-get update \
    && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
        libegl1 libegl-mesa0 libxrender1 \
    && rm -rf /var/lib/apt/lists/* \
    && pip install --constraint locks/run.txt ".[aero,dask,studio,video]"
# compiled loops are kept here between runs of a container whose /data is a volume
ENV NUMBA_CACHE_DIR=/data/.numba
WORKDIR /data
EXPOSE 8080
ENTRYPOINT ["bladegen"]
CMD ["--help"]
